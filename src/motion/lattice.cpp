#include "blackleaf/lattice.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "blackleaf/error.h"
#include "lattice_move.h"
#include "octree/produce.h"
#include "shift_producer.h"
#include "symmetry_producer.h"

namespace blackleaf {
namespace detail {

std::optional<LatticeMove> lattice_move(const FixedMotion& motion, int depth) {
  constexpr std::int64_t kOne = std::int64_t{1} << FixedMotion::kFractionBits;
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      rotation(j, i) = std::ldexp(
          static_cast<double>(motion.inverse_rotation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]),
          -FixedMotion::kFractionBits);
  const auto symmetry = LatticeSymmetry::from(rotation);
  if (!symmetry) return std::nullopt;
  LatticeMove result{*symmetry, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t shift = motion.forward_translation[i];
    if ((shift & (kOne - 1)) == kOne / 2) return std::nullopt;
    result.by[i] = (shift + kOne / 2) >> FixedMotion::kFractionBits;
    if (symmetry->reversed(static_cast<int>(i))) result.by[i] -= std::int64_t{1} << depth;
  }
  return result;
}

std::array<std::int64_t, 3> shift_after(const LatticeSymmetry& symmetry, const Eigen::Vector3d& about, int depth) {
  const Eigen::Vector3d from_centre = about - Eigen::Vector3d::Constant(std::exp2(depth - 1));
  const Eigen::Vector3d by = from_centre - symmetry.matrix() * from_centre;
  std::array<std::int64_t, 3> shift{};
  for (int i = 0; i < 3; ++i) {
    constexpr double kFar = 0x1p40;  // out of every universe, and whole
    if (std::isnan(by[i]) || (by[i] != std::round(by[i]) && std::abs(by[i]) < kFar))
      throw Error(ErrorCode::bad_argument,
                  "that turn or reflection about " + std::to_string(about.x()) + "," + std::to_string(about.y()) + "," +
                      std::to_string(about.z()) + " does not take voxels to voxels",
                  "do it about a corner or the centre of a voxel");
    shift[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::clamp(by[i], -kFar, kFar));
  }
  return shift;
}

Octree moved(const Octree& octree, const LatticeMove& move, int depth, const Frame& frame, const Work& work) {
  const bool turns = !(move.symmetry == LatticeSymmetry());
  const bool shifts = move.by != std::array<std::int64_t, 3>{} || depth != octree.depth();
  const Octree turned = turns ? transform(octree, move.symmetry, shifts ? part_of(work, 0, 0.5) : work) : octree;
  if (!shifts) return turned.with_frame(frame);
  return produce(ShiftProducer(move.by, turned, depth), depth, frame, turns ? part_of(work, 0.5, 1) : work);
}

}  // namespace detail

std::optional<LatticeSymmetry> LatticeSymmetry::from(const Eigen::Matrix3d& matrix) {
  LatticeSymmetry result;
  for (int i = 0; i < 3; ++i) {
    int entries = 0;
    for (int j = 0; j < 3; ++j) {
      const double entry = matrix(i, j);
      if (entry == 0) continue;
      if (std::abs(entry) != 1) return std::nullopt;
      ++entries;
      result.source_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(j);
      result.reversed_[static_cast<std::size_t>(i)] = entry < 0;
    }
    if (entries != 1) return std::nullopt;
  }
  const auto& from = result.source_;
  if (from[0] == from[1] || from[1] == from[2] || from[0] == from[2]) return std::nullopt;
  return result;
}

const std::array<LatticeSymmetry, 48>& LatticeSymmetry::all() {
  static const std::array<LatticeSymmetry, 48> symmetries = [] {
    std::array<LatticeSymmetry, 48> found;
    // The permutations of the axes times the reversals.
    constexpr std::array<std::array<std::uint8_t, 3>, 6> kOrders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::size_t i = 0; i < found.size(); ++i) {
      found[i].source_ = kOrders[i / 8];
      for (std::size_t axis = 0; axis < 3; ++axis) found[i].reversed_[axis] = (i >> axis & 1) != 0;
    }
    return found;
  }();
  return symmetries;
}

Eigen::Matrix3d LatticeSymmetry::matrix() const {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) result(i, source(i)) = reversed(i) ? -1 : 1;
  return result;
}

Octree transform(const Octree& octree, const LatticeSymmetry& symmetry, const Work& work) {
  if (symmetry == LatticeSymmetry() || !octree.root().is_gray()) return octree;
  return detail::produce(detail::SymmetryProducer(octree, symmetry), octree.depth(), octree.frame(), work);
}

Octree transform(const Octree& octree, const LatticeSymmetry& symmetry, const Eigen::Vector3d& about, Leaving leaving,
                 const Work& work) {
  const auto by = detail::shift_after(symmetry, about, octree.depth());
  return translate(transform(octree, symmetry, detail::part_of(work, 0, 0.5)), by, leaving,
                   detail::part_of(work, 0.5, 1));
}

}  // namespace blackleaf
