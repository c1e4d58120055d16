// First contact: when does a solid on its way first come to another one, and is the way clear.
//
// Meaning. d(t) is the distance at time t of the exact solids, all cubes as they are, tilted, nothing voxelised; it is
// 0 when they touch or interfere. Every answer holds for all of the path's infinitely many times, none is sampled:
//
//   no first contact, clear:  d(t) > clearance at every time of the path; this is proven.
//   first contact at t*:      d(t) > clearance at all times before t*; this is proven. And d(t*) <= clearance +
//                             tolerance.
//
// So contact is never told too late, whatever the speed and however thin the walls; only what comes within `tolerance`
// of contact without reaching it may be told as contact. What slides along another solid and touches it is in contact:
// touching is not interference, but there is no clearance left. So is a path that begins or ends touching: t* is then
// where the distance falls to the tolerance.
//
// To allow what only touches, give a negative clearance: with clearance = -e, contact is two black boxes that overlap
// more than e deep (depth: the shortest shift that parts them). A clear path then has no voxel of one solid deeper than
// e in a voxel of the other, and a first contact has two boxes of black voxels at least e - tolerance deep in each
// other.
//
// The path is followed as its numbers say (path.h); what positions in double precision are off by, less than 2^-42 of
// the coordinates' size, is allowed for on the safe side.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "blackleaf/path.h"
#include "blackleaf/prepared_solid.h"
#include "blackleaf/work.h"

namespace blackleaf {

struct ContactOptions {
  double clearance = 0;     // voxels: contact is to come this near
  double tolerance = 1e-3;  // voxels: what comes nearer than clearance + tolerance may be called contact
};

struct FirstContact {
  double time = 0;
  Pose pose_a, pose_b;  // at that time
  double distance = 0;  // then; negative: how deep two boxes are in each other
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero(), on_b = Eigen::Vector3d::Zero();  // nearest points then
};

/// The first contact of `b` on its path with `a` at rest, or none if the way is clear. Throws Error(bad_argument) when
/// depths differ, when clearance is not finite, and when the tolerance is not finite or too small for the coordinates
/// (2^-38 of their size). Intervals of time and pairs of nodes are halved where they are not yet proven apart;
/// docs/FIRST_CONTACT.md has the bounds.
std::optional<FirstContact> first_contact(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b,
                                          const ContactOptions& options = {}, const Work& work = {});
/// The same when both move. Times are those of both paths; each rests before its first and after its last pose.
std::optional<FirstContact> first_contact(const PreparedSolid& a, const Path& path_of_a, const PreparedSolid& b,
                                          const Path& path_of_b, const ContactOptions& options = {},
                                          const Work& work = {});

/// True: the distance is more than options.clearance at all times, proven. False: at some time it is at most
/// options.clearance + options.tolerance. Usually faster than first_contact() when the way is not clear. Throws as
/// that.
bool clear(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b, const ContactOptions& options = {},
           const Work& work = {});
bool clear(const PreparedSolid& a, const Path& path_of_a, const PreparedSolid& b, const Path& path_of_b,
           const ContactOptions& options = {}, const Work& work = {});

/// Bounds on the least distance over a stretch of time.
struct Clearance {
  double begin = 0, end = 0;         // the times, both included
  double at_least = 0, at_most = 0;  // proven bounds on the least distance between them
  double time = 0;                   // one at which the distance is at most `at_most`
};
/// The least distance along the way, at_most - at_least <= precision; none if one solid is empty. Throws as
/// first_contact() for a precision that is too small.
std::optional<Clearance> clearance(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b,
                                   double precision = 1e-2, const Work& work = {});
/// The same for every stretch between neighbouring times (increasing, two at least), in order. Throws
/// Error(bad_argument) for times that are not. Empty if one solid is empty.
std::vector<Clearance> clearance_along(const PreparedSolid& a, const PreparedSolid& b, const Path& path_of_b,
                                       const std::vector<double>& times, double precision = 1e-2,
                                       const Work& work = {});

}  // namespace blackleaf
