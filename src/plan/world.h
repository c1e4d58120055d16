// World: what is free, the one question that planning asks again and again.
//
// The universe's walls are made part of the environment: it is placed in the middle of a universe of twice the side
// whose rest is black, so that one check decides both, for whole motions too.
//
// Margins. Planning demands kMargin more clearance than was asked for, and lets first_contact.h call what comes
// kTolerance nearer than that contact, which is quick. The last check of a path demands what was asked for, to less
// than kMargin: so what planning found free passes it, although it is told in the environment's own universe, where
// positions are rounded otherwise.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "blackleaf/distance.h"
#include "blackleaf/first_contact.h"
#include "blackleaf/measures.h"
#include "blackleaf/plan.h"

namespace blackleaf::detail {

inline constexpr double kMargin = 0x1p-8, kTolerance = 0x1p-7, kLastTolerance = 0x1p-9;  // voxels

/// The pose on the way from one to another, t in [0, 1], as Path has it.
Pose pose_between(const Pose& from, const Pose& to, double t);

class World {
 public:
  /// `clearance` is asked for, voxels. Throws Error(bad_argument) when depths differ, the environment is deeper than 19
  /// or the object is empty.
  World(const Octree& environment, const Octree& object, double clearance, const Work& work);

  const Octree& environment() const { return environment_; }
  const Octree& object() const { return object_; }
  const PreparedSolid& prepared_environment() const { return prepared_environment_; }
  const PreparedSolid& prepared_object() const { return prepared_object_; }
  double clearance_asked() const { return clearance_; }
  /// The object's centroid.
  const Eigen::Vector3d& about() const { return about_; }
  const Box& box() const { return box_; }
  /// Largest distance of a corner of the object's box from its centroid.
  double radius() const { return radius_; }

  /// A bound on the way of any point of the object: |dT| + angle * radius().
  double distance(const Pose& from, const Pose& to) const;
  /// The motion of the object that a pose is.
  Motion motion(const Pose& pose) const;

  /// Whether the object is clear of the environment and in the universe, with the margin.
  bool is_free(const Pose& pose) const;
  /// The same at every time of a motion. Requires: both ends are free.
  bool is_free(const Pose& from, const Pose& to) const;
  /// The part of a motion from a free pose that is free, in [0, 1]; 1 iff all of it is.
  double free_part(const Pose& from, const Pose& to) const;

  /// The last check, without the margin.
  bool is_clear(const Path& path, const Work& work) const;

  /// The object's nearest approach to the environment without the walls; none if that is more than `up_to` voxels away.
  std::optional<MovedDistance> nearest(const Pose& pose, double up_to) const;

  std::uint64_t poses_tried() const { return poses_tried_; }
  std::uint64_t motions_tried() const { return motions_tried_; }

 private:
  Path placed_path(std::vector<Pose> poses) const;

  Octree environment_, object_;
  double clearance_;
  Eigen::Vector3d about_, placed_about_;
  Box box_;
  double radius_ = 0;
  PreparedSolid prepared_environment_, prepared_object_;
  PreparedSolid walled_, placed_;  // the same in the middle of the larger universe
  mutable std::uint64_t poses_tried_ = 0, motions_tried_ = 0;
};

}  // namespace blackleaf::detail
