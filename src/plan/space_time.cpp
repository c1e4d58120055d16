#include "space_time.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

namespace blackleaf::detail {
namespace {

Pose at_time(Pose pose, double time) {
  pose.time = time;
  return pose;
}

// The pose on a motion in time.
Pose between(const Pose& from, const Pose& to, double part) {
  return at_time(pose_between(from, to, part), from.time + part * (to.time - from.time));
}

class Tree {
 public:
  Tree(const World& world, const Traffic& traffic, const std::vector<Pose>& guide, double speed, Random random)
      : world_(world), traffic_(traffic), guide_(guide), speed_(speed), random_(random) {
    nodes_.push_back({at_time(guide.front(), 0), 0});
    double length = 0;
    for (std::size_t i = 1; i < guide.size(); ++i) length += world.distance(guide[i - 1], guide[i]);
    // Time enough to let everybody pass and then go there and back again.
    horizon_ = traffic.end() + 4 * (length + 4 * world.radius()) / speed;
  }

  Found grow(const std::function<bool()>& stop) {
    while (!stop()) {
      const double draw = random_.uniform();
      if (draw < 0.15) {
        if (grow_to_goal()) return {true, way_to(nodes_.size() - 1)};
      } else if (draw < 0.3) {
        wait();
      } else if (draw < 0.75) {
        Pose target = on_guide();
        if (random_.uniform() < 0.5) target = nudged(target);
        grow_toward(target);
      } else {
        grow_toward(anywhere());
      }
    }
    const Pose& goal = guide_.back();
    const auto nearer = [&](const Node& a, const Node& b) {
      return world_.distance(a.pose, goal) < world_.distance(b.pose, goal);
    };
    return {false,
            way_to(static_cast<std::size_t>(std::min_element(nodes_.begin(), nodes_.end(), nearer) - nodes_.begin()))};
  }

 private:
  struct Node {
    Pose pose;
    std::size_t parent;
  };

  double range() const { return 2 * world_.radius(); }
  double arrival(const Node& node, const Pose& pose) const {
    return node.pose.time + world_.distance(node.pose, pose) / speed_;
  }

  Pose on_guide() {
    const double at = random_.uniform(0, static_cast<double>(guide_.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(at), guide_.size() - 2);
    return at_time(pose_between(guide_[i], guide_[i + 1], at - static_cast<double>(i)), random_.uniform(0, horizon_));
  }
  Pose nudged(const Pose& pose) {
    const double reach = world_.radius();
    if (random_.uniform() < 0.5) {
      // Aside along one axis, as out of a lane.
      Pose aside = pose;
      const auto axis = static_cast<Eigen::Index>(3 * random_.uniform());
      aside.translation[axis] += random_.uniform(-3 * reach, 3 * reach);
      return aside;
    }
    return {pose.time, pose.translation + random_.vector(-reach, reach),
            (pose.rotation * random_.small_rotation(0.5)).normalized()};
  }
  Pose anywhere() {
    const Eigen::Vector3d place = random_.vector(0, world_.environment().side());
    return {random_.uniform(0, horizon_), place - world_.about(), random_.rotation()};
  }

  // Somewhere in the tree, for a while.
  void wait() {
    const auto from = static_cast<std::size_t>(random_.uniform() * static_cast<double>(nodes_.size()));
    const Pose& begin = nodes_[from].pose;
    const Pose end = at_time(begin, begin.time + random_.uniform(0, horizon_ / 2));
    if (free_between(begin, end)) nodes_.push_back({end, from});
  }

  // From the node that can be there in time and is nearest, in length and in time, as far as `range()`. Half of the
  // times as early as can be, whatever time was drawn.
  void grow_toward(Pose target) {
    const bool early = random_.uniform() < 0.5;
    if (early) target.time = std::numeric_limits<double>::infinity();
    std::optional<std::size_t> from;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (arrival(nodes_[i], target) > target.time) continue;
      const double apart = world_.distance(nodes_[i].pose, target) +
                           0.25 * speed_ * (early ? nodes_[i].pose.time : target.time - nodes_[i].pose.time);
      if (apart < least) {
        least = apart;
        from = i;
      }
    }
    if (!from) return;
    if (early) target.time = arrival(nodes_[*from], target);
    const Pose& begin = nodes_[*from].pose;
    const double length = world_.distance(begin, target);
    const Pose end = length > range() ? between(begin, target, range() / length) : target;
    if (free_between(begin, end)) nodes_.push_back({end, *from});
  }

  // From the nodes that reach the goal first, one motion each.
  bool grow_to_goal() {
    const Pose& goal = guide_.back();
    const Node* first = nullptr;
    // Not always the same node: a random part of them is asked.
    const double share = random_.uniform();
    for (const Node& node : nodes_)
      if ((!first || arrival(node, goal) < arrival(*first, goal)) && random_.uniform() < share) first = &node;
    if (!first) return false;
    const Pose begin = first->pose;
    const auto parent = static_cast<std::size_t>(first - nodes_.data());
    const double length = world_.distance(begin, goal);
    const bool whole = length <= 2 * range();
    const Pose target = at_time(goal, arrival(*first, goal));
    const Pose end = whole ? target : between(begin, target, range() / length);
    if (!(end.time > begin.time) || !free_between(begin, end)) return false;
    nodes_.push_back({end, parent});
    return whole && traffic_.may_rest(end, end.time);
  }

  bool free_between(const Pose& from, const Pose& to) const {
    if (!(to.time > from.time)) return false;
    return world_.is_free(from, to) && traffic_.is_free(from, to);
  }

  std::vector<Pose> way_to(std::size_t node) const {
    std::vector<Pose> way{nodes_[node].pose};
    for (; node != 0; node = nodes_[node].parent) way.push_back(nodes_[nodes_[node].parent].pose);
    std::reverse(way.begin(), way.end());
    return way;
  }

  const World& world_;
  const Traffic& traffic_;
  const std::vector<Pose>& guide_;
  double speed_, horizon_ = 0;
  Random random_;
  std::vector<Node> nodes_;
};

}  // namespace

Found search_in_time(const World& world, const Traffic& traffic, const std::vector<Pose>& guide, double speed,
                     Random random, const std::function<bool()>& stop) {
  std::vector<Pose> way{at_time(guide.front(), 0)};
  bool free = true;
  for (std::size_t i = 1; free && i < guide.size(); ++i) {
    const double length = world.distance(guide[i - 1], guide[i]);
    if (!(length > 0)) continue;
    const Pose next = at_time(guide[i], way.back().time + length / speed);
    free = traffic.is_free(way.back(), next);
    way.push_back(next);
  }
  if (free && traffic.may_rest(way.back(), way.back().time)) return {true, way};
  const std::vector<Pose> resting{guide.front(), guide.front()};  // at the goal already, where somebody passes
  return Tree(world, traffic, guide.size() < 2 ? resting : guide, speed, random).grow(stop);
}

std::vector<Pose> shorten_in_time(const World& world, const Traffic& traffic, std::vector<Pose> way, double speed,
                                  Random random, const std::function<bool()>& stop) {
  constexpr int kTries = 150;
  for (int i = 0; i < kTries && way.size() > 2 && !stop(); ++i) {
    const auto last = static_cast<double>(way.size() - 1);
    auto from = static_cast<std::size_t>(random.uniform(0, last + 1)),
         to = static_cast<std::size_t>(random.uniform(0, last + 1));
    if (from > to) std::swap(from, to);
    if (to - from < 2) continue;
    const Pose &begin = way[from], &end = way[to];
    const double length = world.distance(begin, end);
    if (length > speed * (end.time - begin.time)) continue;
    if (!world.is_free(begin, end) || !traffic.is_free(begin, end)) continue;
    way.erase(way.begin() + static_cast<std::ptrdiff_t>(from) + 1, way.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return way;
}

}  // namespace blackleaf::detail
