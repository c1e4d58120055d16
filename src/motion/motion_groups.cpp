#include "motion_groups.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace blackleaf::detail {
namespace {

constexpr double kUnit = 0x1p-39;  // of source coordinates, in voxels
// The moved solid is found here with real numbers, not with the rounded motion, which differs by less than 2^-16
// voxels, and the arithmetic of doubles adds less than 2^-20.
constexpr double kRegionMargin = 0x1p-10;
// Deviations are sums of a dozen products below 2^22 voxels, each off by 2^-52 of itself.
constexpr double kDeviationMargin = 0x1p-20;
// Beyond this slack a box holds the whole source: with motions that bring the solid to the universe, every q of a point
// of the universe lies within sqrt(3) 2^20 of it, |q| < 2.8 * 2^20 voxels, and with the source in [0, 2^20]^3 no
// distance matters that is longer than 2^22 voxels. So all sums stay below 2^63.
constexpr std::int64_t kMostSlack = std::int64_t{1} << (kSourceBits + 22);

}  // namespace

MovedBackCentres::MovedBackCentres(const FixedMotion& motion) : motion_(motion) {
  for (std::size_t i = 0; i < 3; ++i)
    for (const std::int64_t entry : motion.inverse_rotation[i]) reach_[i] += std::abs(entry);
}

MotionGroups::MotionGroups(const std::vector<FixedMotion>& motions, const Box& box, int target_depth) {
  const double side = std::ldexp(1.0, target_depth);
  for (const FixedMotion& motion : motions) {
    // X' = R X + T with R the transpose of A.
    std::array<std::array<double, 3>, 2> region{};
    bool near = true;
    for (std::size_t i = 0; i < 3; ++i) {
      double low = std::ldexp(static_cast<double>(motion.forward_translation[i]), -FixedMotion::kFractionBits);
      double high = low;
      for (std::size_t j = 0; j < 3; ++j) {
        const double r = std::ldexp(static_cast<double>(motion.inverse_rotation[j][i]), -FixedMotion::kFractionBits);
        low += r * (r > 0 ? box.min[j] : box.max[j]);
        high += r * (r > 0 ? box.max[j] : box.min[j]);
      }
      region[0][i] = std::max(low - kRegionMargin, 0.0);
      region[1][i] = std::min(high + kRegionMargin, side);
      near = near && region[0][i] <= region[1][i];
    }
    if (!near) continue;
    motions_.emplace_back(motion);
    regions_.push_back(region);
  }
  if (motions_.empty()) return;
  groups_.reserve(2 * motions_.size() - 1);
  build(0, static_cast<std::uint32_t>(motions_.size() - 1));
}

// Twice: half, then the halves' slacks and how far their inner ends are off the line between the outer ones.
std::uint32_t MotionGroups::build(std::uint32_t first, std::uint32_t last) {
  const auto index = static_cast<std::uint32_t>(groups_.size());
  groups_.push_back({first, last, 0, {}, regions_[first][0], regions_[first][1]});
  if (first == last) return index;
  const std::uint32_t middle = first + (last - first) / 2;
  const std::uint32_t one = build(first, middle), two = build(middle + 1, last);
  Group group{first, last, two, {}, groups_[one].low, groups_[one].high};
  for (std::size_t i = 0; i < 3; ++i) {
    group.low[i] = std::min(group.low[i], groups_[two].low[i]);
    group.high[i] = std::max(group.high[i], groups_[two].high[i]);
  }
  // A place by a motion of the first half is at most its slack off the line between the places by `first` and `middle`,
  // and that line, whose one end is on our line, nowhere farther off ours than its other end.
  const SourcePoint off_one = deviation(middle, group), off_two = deviation(middle + 1, group);
  for (std::size_t i = 0; i < 3; ++i)
    group.slack[i] =
        std::min(std::max(off_one[i] + groups_[one].slack[i], off_two[i] + groups_[two].slack[i]), kMostSlack);
  groups_[index] = group;
  return index;
}

// How far, along each axis, a point of the group's region may by a motion lie off the line between its places by the
// group's first and last motion: the difference is affine in the point, so its largest size on a box is that at the
// centre and the sum of what each axis adds.
SourcePoint MotionGroups::deviation(std::uint32_t motion, const Group& group) const {
  if (motion == group.first || motion == group.last) return {};
  const double part = static_cast<double>(motion - group.first) / static_cast<double>(group.last - group.first);
  const FixedMotion &m = motions_[motion].motion(), &a = motions_[group.first].motion(),
                    &b = motions_[group.last].motion();
  const auto differs = [&](std::int64_t of_m, std::int64_t of_a, std::int64_t of_b) {
    return std::ldexp(static_cast<double>(of_m - of_a) - part * static_cast<double>(of_b - of_a),
                      -FixedMotion::kFractionBits);
  };
  SourcePoint result;
  for (std::size_t i = 0; i < 3; ++i) {
    double at_centre = differs(m.inverse_translation[i], a.inverse_translation[i], b.inverse_translation[i]);
    double around = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const double slope = differs(m.inverse_rotation[i][j], a.inverse_rotation[i][j], b.inverse_rotation[i][j]);
      at_centre += slope * (group.low[j] + group.high[j]) / 2;
      around += std::abs(slope) * (group.high[j] - group.low[j]) / 2;
    }
    const double units = (std::abs(at_centre) + around + kDeviationMargin) / kUnit;
    result[i] = units < static_cast<double>(kMostSlack) ? static_cast<std::int64_t>(units) + 1 : kMostSlack;
  }
  return result;
}

bool MotionGroups::reaches(const Group& group, const Cube& cube) const {
  const std::array<std::int32_t, 3> low = {cube.x, cube.y, cube.z};
  for (std::size_t i = 0; i < 3; ++i)
    if (low[i] > group.high[i] || low[i] + cube.side() < group.low[i]) return false;
  return true;
}

}  // namespace blackleaf::detail
