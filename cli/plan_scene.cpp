#include "plan_scene.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "blackleaf/align.h"
#include "blackleaf/error.h"
#include "blackleaf/resample.h"
#include "options.h"

namespace blackleaf::cli {
namespace {

// "2 mm", or "2 x 2 x 3 mm".
std::string voxel_size(const Frame& frame) {
  const Eigen::Vector3d sides = frame.axes.colwise().norm();
  const bool cube = (sides.array() - sides[0]).abs().maxCoeff() <= 1e-9 * sides[0];
  return cube ? fmt::format("{:.10g} {}", sides[0], frame.unit)
              : fmt::format("{:.10g} x {:.10g} x {:.10g} {}", sides[0], sides[1], sides[2], frame.unit);
}

[[noreturn]] void refuse_lattice(const Octree& environment, const std::string& environment_name, const Octree& octree,
                                 const std::string& name) {
  const std::string ours = voxel_size(environment.frame()), theirs = voxel_size(octree.frame());
  if (ours != theirs)
    throw Error(ErrorCode::bad_argument,
                fmt::format("'{}' has voxels of {} and '{}' of {}", environment_name, ours, name, theirs),
                "build both in one universe, with build --like, or give --resample OUT.octree");
  throw Error(
      ErrorCode::bad_argument,
      fmt::format("the voxels of '{}' and '{}' do not lie on each other: their frames are shifted by parts of a "
                  "voxel or turned",
                  environment_name, name),
      "build both in one universe, with build --like, or give --resample OUT.octree");
}

}  // namespace

Placed place_in(Session& session, const Octree& environment, const std::string& environment_name, const Octree& octree,
                const std::string& name, bool resample_it) {
  Placed placed{name, octree};
  if (octree.depth() == environment.depth() && octree.frame().same_as(environment.frame())) return placed;
  const auto shift = whole_shift(octree.frame(), environment.frame());
  if (!shift) {
    if (!resample_it) refuse_lattice(environment, environment_name, octree, name);
    placed.octree = session.stage("resample", [&](const Work& work) {
      return resampled(octree, environment.frame(), environment.depth(), work);
    });
    placed.resampled = true;
    return placed;
  }
  const std::array<Octree, 2> both = {environment, octree};
  const std::vector<Octree> together = session.stage("align", [&](const Work& work) { return aligned(both, work); });
  if (together[0].depth() != environment.depth())
    throw Error(ErrorCode::bad_argument,
                fmt::format("'{}' does not lie in the universe of '{}', by their frames", name, environment_name),
                "grow the universe of the environment or move the solid into it");
  placed.octree = together[1];
  for (std::size_t i = 0; i < 3; ++i) placed.shift[static_cast<Eigen::Index>(i)] = static_cast<double>((*shift)[i]);
  return placed;
}

Pose parse_pose(const std::string& option, const std::string& text) {
  const std::size_t at = text.find('@');
  Pose pose;
  try {
    pose.translation = parse_vector(option, text.substr(0, at));
    if (at != std::string::npos) pose.rotation = parse_rotation(option, text.substr(at + 1)).quaternion();
  } catch (const Error&) {
    throw Error(ErrorCode::bad_argument, fmt::format("{} is '{}', which is no pose", option, text),
                "write x,y,z or x,y,z@x,y,z:degrees, a shift and a turn about the centroid, like 10,0,-2.5@0,0,1:90");
  }
  return pose;
}

std::string shown(const Pose& pose) {
  // Adding 0 turns -0 into 0.
  const auto vector = [](const Eigen::Vector3d& v) {
    return fmt::format("{:.6g},{:.6g},{:.6g}", v[0] + 0, v[1] + 0, v[2] + 0);
  };
  const Eigen::AngleAxisd turn(pose.rotation);
  const double degrees = turn.angle() * 180 / std::numbers::pi;
  if (degrees == 0) return vector(pose.translation);
  return fmt::format("{}@{}:{:.6g}", vector(pose.translation), vector(turn.axis()), degrees);
}

}  // namespace blackleaf::cli
