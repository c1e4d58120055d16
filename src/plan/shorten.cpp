#include "shorten.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace blackleaf::detail {
namespace {

constexpr double kLess = 1 - 1e-6;  // of a cost that is worth a change

class Shortener {
 public:
  Shortener(const World& world, std::vector<Pose> way, const MotionCost& cost, Random random,
            const std::function<bool()>& stop)
      : world_(world), way_(std::move(way)), cost_of_(cost), random_(random), stop_(stop) {
    for (std::size_t i = 1; i < way_.size(); ++i) costs_.push_back(cost(way_[i - 1], way_[i]));
  }

  // From a random place of the way straight to another one, as long as that helps now and then.
  void cut(int most_failures, int most_tries) {
    int failures = 0;
    for (int i = 0; i < most_tries && failures < most_failures && way_.size() > 2 && !stop_(); ++i)
      failures = cut_once() ? 0 : failures + 1;
  }

  // Every corner is cut off at a quarter of its sides, or nearer to it where that is not free.
  void round_corners() {
    if (way_.size() < 3) return;
    std::vector<Pose> rounder{way_.front()};
    for (std::size_t i = 1; i + 1 < way_.size(); ++i) {
      bool cut = false;
      for (double part = 0.25; !cut && part > 0.05 && !stop_(); part /= 2) {
        const Pose before = pose_between(way_[i], way_[i - 1], part), after = pose_between(way_[i], way_[i + 1], part);
        if (cost(before, after) >= kLess * (part * (costs_[i - 1] + costs_[i]))) break;
        cut = world_.is_free(before, after);
        if (cut) rounder.insert(rounder.end(), {before, after});
      }
      if (!cut) rounder.push_back(way_[i]);
    }
    rounder.push_back(way_.back());
    set_way(std::move(rounder));
  }

  // Poses are pushed away from what is nearer than `preferred`, shifted and turned a little this way and that, less and
  // less, and stay where they make the way cheaper.
  void relax(double preferred, int rounds) {
    divide(preferred);
    double reach = preferred;
    for (int round = 0; round < rounds && !stop_(); ++round, reach *= 0.75)
      for (std::size_t i = 1; i + 1 < way_.size(); ++i) {
        if (const auto near = world_.nearest(way_[i], preferred); near && near->voxels > 0) {
          Pose pushed = way_[i];
          pushed.translation += (near->on_b - near->on_a) * (preferred / near->voxels - 1);
          if (!try_instead(i, pushed)) {
            pushed.translation = (pushed.translation + way_[i].translation) / 2;
            try_instead(i, pushed);
          }
        }
        Pose shifted = way_[i];
        shifted.translation += random_.vector(-reach, reach) / 2;
        try_instead(i, shifted);
        Pose turned = way_[i];
        turned.rotation = (turned.rotation * random_.small_rotation(reach / world_.radius() / 2)).normalized();
        try_instead(i, turned);
      }
  }

  std::vector<Pose> way() && { return std::move(way_); }

 private:
  double cost(const Pose& from, const Pose& to) const { return cost_of_(from, to); }

  bool try_instead(std::size_t i, const Pose& pose) {
    const double before = cost(way_[i - 1], pose), after = cost(pose, way_[i + 1]);
    if (before + after >= kLess * (costs_[i - 1] + costs_[i])) return false;
    if (!world_.is_free(way_[i - 1], pose) || !world_.is_free(pose, way_[i + 1])) return false;
    way_[i] = pose;
    costs_[i - 1] = before;
    costs_[i] = after;
    return true;
  }

  void set_way(std::vector<Pose> way) {
    way_ = std::move(way);
    costs_.clear();
    for (std::size_t i = 1; i < way_.size(); ++i) costs_.push_back(cost(way_[i - 1], way_[i]));
  }

  // A motion of the way and the part of it, evenly over the cost.
  std::pair<std::size_t, double> random_place() {
    double total = 0;
    for (const double each : costs_) total += each;
    double at = random_.uniform(0, total);
    std::size_t i = 0;
    for (; i + 1 < costs_.size() && at >= costs_[i]; ++i) at -= costs_[i];
    double part = costs_[i] > 0 ? std::min(at / costs_[i], 1.0) : 0;
    // Corners are good places to begin at and to end at.
    if (random_.uniform() < 0.5) part = part < 0.5 ? 0 : 1;
    return {i, part};
  }

  bool cut_once() {
    auto [i, p] = random_place();
    auto [j, q] = random_place();
    if (i > j || (i == j && p > q)) {
      std::swap(i, j);
      std::swap(p, q);
    }
    if (i == j || (i + 1 == j && p == 1) || (i + 1 == j && q == 0) || (i + 2 == j && p == 1 && q == 0)) return false;
    const Pose from = pose_between(way_[i], way_[i + 1], p), to = pose_between(way_[j], way_[j + 1], q);
    double old = (1 - p) * costs_[i] + q * costs_[j];
    for (std::size_t k = i + 1; k < j; ++k) old += costs_[k];
    if (cost(from, to) >= kLess * old || !world_.is_free(from, to)) return false;
    std::vector<Pose> shorter(way_.begin(), way_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    if (p > 0) shorter.push_back(from);
    shorter.push_back(to);
    shorter.insert(shorter.end(), way_.begin() + static_cast<std::ptrdiff_t>(j) + (q < 1 ? 1 : 2), way_.end());
    set_way(std::move(shorter));
    return true;
  }

  // No motion longer than `most`.
  void divide(double most) {
    std::vector<Pose> finer{way_.front()};
    for (std::size_t i = 1; i < way_.size(); ++i) {
      const auto parts = static_cast<std::int64_t>(world_.distance(way_[i - 1], way_[i]) / most) + 1;
      for (std::int64_t k = 1; k < parts; ++k)
        finer.push_back(pose_between(way_[i - 1], way_[i], static_cast<double>(k) / static_cast<double>(parts)));
      finer.push_back(way_[i]);
    }
    set_way(std::move(finer));
  }

  const World& world_;
  std::vector<Pose> way_;
  std::vector<double> costs_;  // of the motion that follows each pose
  const MotionCost& cost_of_;
  Random random_;
  const std::function<bool()>& stop_;
};

}  // namespace

std::vector<Pose> shorten(const World& world, std::vector<Pose> way, const MotionCost& cost, double preferred_clearance,
                          Random random, const std::function<bool()>& stop) {
  const MotionCost length = [&](const Pose& from, const Pose& to) { return world.distance(from, to); };
  Shortener shortener(world, std::move(way), cost ? cost : length, random, stop);
  constexpr int kFailures = 30, kTries = 400, kRounds = 8;
  shortener.cut(kFailures, kTries);
  if (preferred_clearance > 0) {
    shortener.relax(preferred_clearance, kRounds);
    shortener.cut(kFailures, kTries);
  }
  shortener.round_corners();
  shortener.round_corners();
  return std::move(shortener).way();
}

}  // namespace blackleaf::detail
