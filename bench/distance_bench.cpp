// distance/N: how far two bunnies are from each other, near contact (the poses of interfere/N; in about half of them
// they interfere). first-contact/N: the first contact on a straight and turning way from each pose to the next.
#include "blackleaf/distance.h"

#include <cmath>

#include "blackleaf/contact.h"
#include "blackleaf/first_contact.h"
#include "contact_poses.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

// From one pose of the bunny to another, about the universe's centre, on a second's way.
Path way(int depth, const Motion& from, const Motion& to) {
  const Eigen::Vector3d about = Eigen::Vector3d::Constant(std::ldexp(1.0, depth - 1));
  const auto pose = [&](double time, const Motion& motion) {
    return Pose{time, motion(about) - about, motion.quaternion()};
  };
  return Path({pose(0, from), pose(1, to)}, about);
}

// A small motion from a pose on: 0.03 of the universe's side and 10 degrees, as planners try them.
Path step(int depth, const Motion& from) {
  const Eigen::Vector3d about = Eigen::Vector3d::Constant(std::ldexp(1.0, depth - 1));
  const Motion further = Motion::translation(Eigen::Vector3d(0.6, -0.64, 0.48) * 0.03 * std::ldexp(1.0, depth)) *
                         Motion::rotation_degrees({1, 2, -2}, 10).about(from(about));
  return way(depth, from, further * from);
}

// What a planner does without: interference at so many instants that no point travels half a voxel between two.
bool sampled(const PreparedSolid& solid, const Path& path, const Box& box) {
  for (const double time : path.times(box, 0.5))
    if (interferes(solid, solid, path.motion_at(time), Meaning::exact)) return true;
  return false;
}

}  // namespace

void add_distance() {
  for (const int depth : {7, 8, 9}) {
    const std::string side = side_name(depth);
    add_timed_poses("distance/" + side, "ours", depth, [=]() -> Ask {
      return [solid = PreparedSolid(bunny(depth))](const Motion& pose) {
        return distance(solid, solid, pose)->voxels > 0;
      };
    });
    add_timed_poses("distance/" + side, "interfere", depth, [=]() -> Ask {
      return [solid = PreparedSolid(bunny(depth))](const Motion& pose) {
        return interferes(solid, solid, pose, Meaning::exact);
      };
    });
    add_timed_poses("farther/" + side, "ours", depth, [=]() -> Ask {
      return [solid = PreparedSolid(bunny(depth))](const Motion& pose) { return farther_than(1, solid, solid, pose); };
    });
    add_timed_poses("first-contact/" + side, "ours", depth, [=]() -> Ask {
      return [=, solid = PreparedSolid(bunny(depth)), last = contact_poses(depth).back()](const Motion& pose) {
        return first_contact(solid, solid, way(depth, last, pose), {}, {1, {}}).has_value();
      };
    });
    add_timed_poses("clear/" + side, "ours", depth, [=]() -> Ask {
      return [=, solid = PreparedSolid(bunny(depth))](const Motion& pose) {
        return clear(solid, solid, step(depth, pose), {}, {1, {}});
      };
    });
    add_timed_poses("clear/" + side, "sampled", depth, [=]() -> Ask {
      return [=, solid = PreparedSolid(bunny(depth)), box = *bounding_box(bunny(depth))](const Motion& pose) {
        return sampled(solid, step(depth, pose), box);
      };
    });
  }
}

}  // namespace blackleaf::bench
