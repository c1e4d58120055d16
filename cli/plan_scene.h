// The scene of `plan`: the environment, what is to move and what moves already, brought into one universe by frames.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blackleaf/plan.h"
#include "labels.h"
#include "session.h"

namespace blackleaf::cli {

/// An octree and where it lies in the environment's universe.
struct Placed {
  std::string name;
  Octree octree;                                    // in the environment's universe
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // of the file's own voxels to the environment's
  bool resampled = false;
  /// A path of the file's own voxels in the environment's, and the other way round.
  Path in_environment(const Path& path) const { return Path(path.poses(), path.about() + shift); }
  Path in_file(const Path& path) const { return Path(path.poses(), path.about() - shift); }
};

/// `octree` of file `name` where its frame says in the universe of `environment`. If its voxels are others and
/// `resample`, its solid in the environment's voxels. Throws Error(bad_argument) that names both when voxels do not lie
/// on each other, or when the solid does not lie in the environment's universe.
Placed place_in(Session& session, const Octree& environment, const std::string& environment_name, const Octree& octree,
                const std::string& name, bool resample);

/// `tx,ty,tz` or `tx,ty,tz@x,y,z:degrees`: turned about the object's centroid, then shifted, in voxels. Throws
/// Error(bad_argument).
Pose parse_pose(const std::string& option, const std::string& text);
/// The same text of a pose, its numbers to six digits.
std::string shown(const Pose& pose);

}  // namespace blackleaf::cli
