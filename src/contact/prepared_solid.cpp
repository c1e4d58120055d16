#include "blackleaf/prepared_solid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "contact_node.h"
#include "octree/brick.h"
#include "octree/node_arrays.h"

namespace blackleaf {
namespace detail {
namespace {

using Normal = std::array<std::int8_t, 3>;

constexpr std::int32_t units_of(std::int32_t side) { return side < 128 ? side : 128; }

/// What is told of a finished node: coordinates are voxels from its corner.
struct Summary {
  std::array<std::int32_t, 3> low{}, high{};
  std::array<std::int64_t, 3> lower_wall{}, upper_wall{};  // black voxels that touch it, by axis

  static Summary black(int level) {
    Summary summary;
    summary.high.fill(std::int32_t{1} << level);
    summary.lower_wall.fill(std::int64_t{1} << (2 * level));
    summary.upper_wall = summary.lower_wall;
    return summary;
  }
};

// By axis: the voxels of a brick whose coordinate is 0, 1, 2, 3.
constexpr auto kLayers = [] {
  std::array<std::array<std::uint64_t, 4>, 3> layers{};
  for (unsigned bit = 0; bit < 64; ++bit) {
    layers[0][brick_x(bit)] |= std::uint64_t{1} << bit;
    layers[1][brick_y(bit)] |= std::uint64_t{1} << bit;
    layers[2][brick_z(bit)] |= std::uint64_t{1} << bit;
  }
  return layers;
}();

Summary summary_of_brick(std::uint64_t bits) {
  Summary summary;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& layers = kLayers[axis];
    std::int32_t low = 0, high = 4;
    while ((bits & layers[static_cast<std::size_t>(low)]) == 0) ++low;
    while ((bits & layers[static_cast<std::size_t>(high - 1)]) == 0) --high;
    summary.low[axis] = low;
    summary.high[axis] = high;
    summary.lower_wall[axis] = std::popcount(bits & layers[0]);
    summary.upper_wall[axis] = std::popcount(bits & layers[3]);
  }
  return summary;
}

// About 127 long; 0 if the surface faces no way.
Normal normal_of(const Summary& summary) {
  std::array<double, 3> sum{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    sum[axis] = static_cast<double>(summary.lower_wall[axis] - summary.upper_wall[axis]);
  const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  Normal normal{};
  if (length > 0)
    for (std::size_t axis = 0; axis < 3; ++axis)
      normal[axis] = static_cast<std::int8_t>(std::lround(sum[axis] / length * 127));
  return normal;
}

class Preparer {
 public:
  Preparer(const Octree& octree, PreparedSolid::Storage& storage)
      : levels_(level_words(octree)), bounds_(storage.bounds) {
    for (int level = 3; level <= kMaxDepth; ++level)
      bounds_[static_cast<std::size_t>(level)].resize(octree.words(level).size());
  }

  /// Fills the bounds of a gray node and of all below it.
  Summary prepare(int level, std::uint64_t index) {
    const std::uint64_t word = levels_[static_cast<std::size_t>(level)][index];
    if (level == 2) return summary_of_brick(word);
    Summary whole;
    whole.low.fill(std::int32_t{1} << level);
    ChildBounds bounds{};
    const std::int32_t half = std::int32_t{1} << (level - 1), unit = ChildBounds::unit(level);
    std::uint64_t next = word >> 16;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      const bool gray = (word >> 8 >> octant & 1) != 0;
      if (!gray && (word >> octant & 1) == 0) continue;
      const Summary child = gray ? prepare(level - 1, next) : Summary::black(level - 1);
      const Normal normal = gray ? normal_of(child) : Normal{};
      std::int64_t reach = normal == Normal{} ? 0 : reach_of(normal, level - 1, next);  // from the child's corner
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool upper = (octant >> axis & 1) != 0;
        const std::int32_t from = upper ? half : 0;
        bounds.low[axis][octant] = static_cast<std::uint8_t>((from + child.low[axis]) / unit);
        bounds.high[axis][octant] = static_cast<std::uint8_t>((from + child.high[axis] + unit - 1) / unit);
        bounds.normal[axis][octant] = normal[axis];
        reach += normal[axis] * std::int64_t{from};
        whole.low[axis] = std::min(whole.low[axis], from + child.low[axis]);
        whole.high[axis] = std::max(whole.high[axis], from + child.high[axis]);
        (upper ? whole.upper_wall : whole.lower_wall)[axis] += (upper ? child.upper_wall : child.lower_wall)[axis];
      }
      // |n|_1 <= 3^0.5 (127 + 1) < 222 and a child reaches 128 units at most: |reach| < 222 * 128 < 2^15.
      bounds.reach[octant] =
          static_cast<std::int16_t>((reach + unit - 1) >> std::countr_zero(static_cast<unsigned>(unit)));
      next += gray ? 1 : 0;
    }
    bounds_[static_cast<std::size_t>(level)][index] = bounds;
    return whole;
  }

  /// The largest n.x of the black points of a gray node, x in voxels from its corner: branch and bound.
  /// Requires: the bounds of the node and of all below it.
  std::int64_t reach_of(const Normal& normal, int level, std::uint64_t index) const {
    std::int64_t best = INT64_MIN;
    seek(normal, level, index, 0, best);
    return best;
  }

 private:
  void seek(const Normal& normal, int level, std::uint64_t index, std::int64_t at_corner, std::int64_t& best) const {
    const std::uint64_t word = levels_[static_cast<std::size_t>(level)][index];
    if (level == 2) {
      for (unsigned octant = 0; octant < 8; ++octant) {
        if ((word >> (8 * octant) & 0xFF) == 0) continue;
        const ByteBox& box = kByteBoxes[word >> (8 * octant) & 0xFF];
        std::int64_t bound = at_corner;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const float end = normal[axis] > 0 ? box.place[axis] + box.half[axis] : box.place[axis] - box.half[axis];
          bound += normal[axis] * std::int64_t{static_cast<int>(end) + ((octant >> axis & 1) != 0 ? 2 : 0)};
        }
        if (bound <= best) continue;
        for (std::uint64_t rest = word >> (8 * octant) & 0xFF; rest != 0; rest &= rest - 1) {
          const auto voxel = static_cast<unsigned>(std::countr_zero(rest));
          std::int64_t sum = at_corner;
          for (std::size_t axis = 0; axis < 3; ++axis)
            sum += normal[axis] * std::int64_t{(voxel >> axis & 1) + (octant >> axis & 1) * 2 + (normal[axis] > 0)};
          best = std::max(best, sum);
        }
      }
      return;
    }
    const ChildBounds& bounds = bounds_[static_cast<std::size_t>(level)][index];
    const std::int64_t unit = ChildBounds::unit(level), half = std::int64_t{1} << (level - 1);
    std::array<std::int64_t, 8> bound;
    unsigned todo = static_cast<unsigned>((word | word >> 8) & 0xFF);
    for (std::size_t octant = 0; octant < 8; ++octant) {
      bound[octant] = at_corner;
      for (std::size_t axis = 0; axis < 3; ++axis)
        bound[octant] +=
            normal[axis] * unit * std::int64_t{normal[axis] > 0 ? bounds.high[axis][octant] : bounds.low[axis][octant]};
    }
    while (todo != 0) {  // the most promising first
      std::size_t first = static_cast<std::size_t>(std::countr_zero(todo));
      for (unsigned rest = todo; rest != 0; rest &= rest - 1) {
        const auto octant = static_cast<std::size_t>(std::countr_zero(rest));
        if (bound[octant] > bound[first]) first = octant;
      }
      if (bound[first] <= best) return;
      todo &= ~(1u << first);
      if ((word >> first & 1) != 0) {
        best = bound[first];  // a black child: its box is exact where it is one of whole units
        continue;
      }
      std::int64_t corner = at_corner;
      for (std::size_t axis = 0; axis < 3; ++axis) corner += (first >> axis & 1) != 0 ? normal[axis] * half : 0;
      const auto before = static_cast<unsigned>(std::popcount(word >> 8 & 0xFF & ((std::uint64_t{1} << first) - 1)));
      seek(normal, level - 1, (word >> 16) + before, corner, best);
    }
  }

  LevelWords levels_;
  std::array<std::vector<ChildBounds>, kMaxDepth + 1>& bounds_;
};

// The root as a node of level 2 at least, without bounds of its own.
ContactNode plain_root(const Octree& octree) {
  const Node node = brick_level_root(octree);
  ContactNode root;
  root.level = node.level();
  root.black = node.is_black();
  root.word = node.is_gray() ? node.word() : 0;
  root.half.fill(0.5F * static_cast<float>(root.side()));
  root.place = root.half;
  return root;
}

}  // namespace

const ChildBounds& ChildBounds::plain(int level) {
  static const auto all = [] {
    std::array<ChildBounds, kMaxDepth + 1> result{};
    for (int k = 1; k <= kMaxDepth; ++k) {
      ChildBounds& bounds = result[static_cast<std::size_t>(k)];
      const std::int32_t half = units_of(std::int32_t{1} << k) / 2;
      for (std::size_t octant = 0; octant < 8; ++octant)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::int32_t low = (octant >> axis & 1) != 0 ? half : 0;
          bounds.low[axis][octant] = static_cast<std::uint8_t>(low);
          bounds.high[axis][octant] = static_cast<std::uint8_t>(low + half);
        }
    }
    return result;
  }();
  return all[static_cast<std::size_t>(level)];
}

ChildBoxes ContactNodes::boxes(const ContactNode& node) {
  ChildBoxes boxes{};
  const ChildBounds& bounds = node.child_bounds();
  const auto unit = static_cast<float>(ChildBounds::unit(node.level));
  for (std::size_t octant = 0; octant < 8; ++octant) {
    // Where it has no bounds for its children a node's own plane is one of theirs.
    boxes.reach[octant] = node.bounds != nullptr ? unit * static_cast<float>(bounds.reach[octant]) : node.reach;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float low = bounds.low[axis][octant], high = bounds.high[axis][octant];
      boxes.place[axis][octant] = 0.5F * unit * (low + high);
      boxes.half[axis][octant] = 0.5F * unit * (high - low);
      boxes.normal[axis][octant] = node.bounds != nullptr ? bounds.normal[axis][octant] : node.normal[axis];
    }
  }
  return boxes;
}

ContactNodes::ContactNodes(const Octree& octree) : words_(level_words(octree)), empty_(octree.is_empty()) {
  if (!empty_) root_ = plain_root(octree);
}

ContactNodes::ContactNodes(const PreparedSolid& tree) : ContactNodes(tree.octree()) {
  const PreparedSolid::Storage& storage = tree.storage();
  for (std::size_t level = 3; level <= kMaxDepth; ++level) bounds_[level] = storage.bounds[level].data();
  root_ = storage.root;
}

}  // namespace detail

PreparedSolid::PreparedSolid(const Octree& octree) {
  auto storage = std::make_shared<Storage>(octree);
  if (!octree.is_empty()) {
    detail::ContactNode& root = storage->root = detail::plain_root(octree);
    if (!root.black && root.level >= 3) {
      detail::Preparer preparer(octree, *storage);
      const detail::Summary summary = preparer.prepare(root.level, 0);
      root.bounds = storage->bounds[static_cast<std::size_t>(root.level)].data();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        root.place[axis] = 0.5F * static_cast<float>(summary.low[axis] + summary.high[axis]);
        root.half[axis] = 0.5F * static_cast<float>(summary.high[axis] - summary.low[axis]);
      }
      const detail::Normal normal = detail::normal_of(summary);
      for (std::size_t axis = 0; axis < 3; ++axis) root.normal[axis] = normal[axis];
      // Rounded up: the numbers need up to 28 bits.
      if (normal != detail::Normal{})
        root.reach = std::nextafter(static_cast<float>(preparer.reach_of(normal, root.level, 0)),
                                    std::numeric_limits<float>::infinity());
    }
  }
  storage_ = std::move(storage);
}

const Octree& PreparedSolid::octree() const { return storage_->octree; }

std::size_t PreparedSolid::memory_bytes() const {
  std::size_t bytes = sizeof(Storage);
  for (const auto& level : storage_->bounds) bytes += level.size() * sizeof(detail::ChildBounds);
  return bytes;
}

}  // namespace blackleaf
