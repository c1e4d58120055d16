#include "traffic.h"

#include <algorithm>
#include <string>
#include <utility>

#include "blackleaf/error.h"

namespace blackleaf::detail {

Path part_of(const Path& path, double from, double to) {
  std::vector<Pose> poses{path.pose_at(from)};
  for (const Pose& pose : path.poses())
    if (pose.time > from && pose.time < to) poses.push_back(pose);
  if (to > from) poses.push_back(path.pose_at(to));
  return Path(std::move(poses), path.about());
}

Traffic::Traffic(std::span<const Mover> movers, const World& world) : world_(world) {
  for (const Mover& mover : movers) {
    if (mover.octree.depth() != world.environment().depth())
      throw Error(ErrorCode::bad_argument,
                  "the environment has depth " + std::to_string(world.environment().depth()) +
                      " and a solid that moves in it has depth " + std::to_string(mover.octree.depth()),
                  "build all in one universe");
    begin_ = std::min(begin_, mover.path.begin());
    end_ = std::max(end_, mover.path.end());
    movers_.push_back({PreparedSolid(mover.octree), mover.path});
  }
}

bool Traffic::is_free(const Pose& from, const Pose& to) const {
  const Path path(from.time < to.time ? std::vector{from, to} : std::vector{from}, world_.about());
  const ContactOptions options{world_.clearance_asked() + kMargin, kTolerance};
  return std::all_of(movers_.begin(), movers_.end(), [&](const Prepared& mover) {
    return clear(mover.solid, part_of(mover.path, from.time, to.time), world_.prepared_object(), path, options);
  });
}

bool Traffic::may_rest(const Pose& pose, double from) const {
  Pose begin = pose, end = pose;
  begin.time = from;
  end.time = std::max(from, end_);
  return is_free(begin, end);
}

bool Traffic::is_clear(const Path& path, const Work& work) const {
  const ContactOptions options{world_.clearance_asked(), kLastTolerance};
  return std::all_of(movers_.begin(), movers_.end(), [&](const Prepared& mover) {
    return clear(mover.solid, mover.path, world_.prepared_object(), path, options, work);
  });
}

std::optional<Traffic::Near> Traffic::nearest(const Pose& pose, double up_to) const {
  std::optional<Near> result;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const Motion place = movers_[i].path.motion_at(pose.time);
    const auto near =
        distance(movers_[i].solid, world_.prepared_object(), place.inverse() * world_.motion(pose), up_to);
    if (!near) continue;
    up_to = near->voxels;
    result = Near{i, {near->voxels, place(near->on_a), place(near->on_b)}};
  }
  return result;
}

}  // namespace blackleaf::detail
