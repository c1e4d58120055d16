// DenseLabels: the slow readable twin of LabelMap: a cube of labels. No cleverness on purpose.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/label_map.h"

namespace blackleaf::reference {

struct DenseLabels {
  int depth = 1;
  std::vector<std::uint32_t> labels;  // x fastest

  explicit DenseLabels(int n) : depth(n), labels(std::size_t{1} << (3 * n), 0) {}

  int side() const { return 1 << depth; }
  std::uint32_t& at(int x, int y, int z) {
    return labels[(static_cast<std::size_t>(z) << depth | static_cast<std::size_t>(y)) << depth |
                  static_cast<std::size_t>(x)];
  }
  std::uint32_t at(int x, int y, int z) const { return const_cast<DenseLabels*>(this)->at(x, y, z); }
  friend bool operator==(const DenseLabels&, const DenseLabels&) = default;

  /// The stream, one voxel after the other.
  std::vector<Run> runs() const {
    std::vector<Run> runs;
    curve::walk(depth, 0, std::uint64_t{1} << (3 * depth), [&](const curve::Voxel& v) {
      const std::uint32_t label = at(v.x, v.y, v.z);
      if (runs.empty() || runs.back().colour != label)
        runs.push_back({1, label});
      else
        ++runs.back().count;
    });
    return runs;
  }

  std::vector<LabelFacts> facts() const {
    std::map<std::uint32_t, LabelFacts> facts;
    for (int z = 0; z < side(); ++z)
      for (int y = 0; y < side(); ++y)
        for (int x = 0; x < side(); ++x) {
          const std::uint32_t label = at(x, y, z);
          if (label == 0) continue;
          LabelFacts& known =
              facts.try_emplace(label, LabelFacts{label, 0, {{x, y, z}, {x + 1, y + 1, z + 1}}}).first->second;
          ++known.volume;
          const std::array<int, 3> p = {x, y, z};
          for (std::size_t i = 0; i < 3; ++i) {
            known.bounding_box.min[i] = std::min(known.bounding_box.min[i], p[i]);
            known.bounding_box.max[i] = std::max(known.bounding_box.max[i], p[i] + 1);
          }
        }
    std::vector<LabelFacts> result;
    for (const auto& [label, known] : facts) result.push_back(known);
    return result;
  }
};

/// One voxel at a time, by looking each up.
inline DenseLabels dense(const LabelMap& map) {
  DenseLabels grid(map.depth());
  for (int z = 0; z < grid.side(); ++z)
    for (int y = 0; y < grid.side(); ++y)
      for (int x = 0; x < grid.side(); ++x) grid.at(x, y, z) = map.label(x, y, z);
  return grid;
}

/// Labels made to be nasty, x fastest, each from `palette`: noise, one label, boxes that touch each other and the
/// walls, a single odd voxel, slanted layers.
inline std::vector<std::uint32_t> random_labels(const std::array<std::int64_t, 3>& size,
                                                const std::vector<std::uint32_t>& palette, std::mt19937& random) {
  const auto pick = [&](std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random);
  };
  const auto any = [&] { return palette[static_cast<std::size_t>(pick(0, std::ssize(palette) - 1))]; };
  std::vector<std::uint32_t> labels(static_cast<std::size_t>(size[0] * size[1] * size[2]), any());
  const auto at = [&](std::int64_t x, std::int64_t y, std::int64_t z) -> std::uint32_t& {
    return labels[static_cast<std::size_t>(x + size[0] * (y + size[1] * z))];
  };
  switch (pick(0, 5)) {
    case 0:
      for (auto& label : labels) label = any();
      break;
    case 1:
      break;
    case 2:
      at(pick(0, size[0] - 1), pick(0, size[1] - 1), pick(0, size[2] - 1)) = any();
      break;
    case 3: {
      const std::int64_t thick = pick(1, 9), a = pick(0, 2), b = pick(0, 2), c = pick(0, 2);
      for (std::int64_t z = 0; z < size[2]; ++z)
        for (std::int64_t y = 0; y < size[1]; ++y)
          for (std::int64_t x = 0; x < size[0]; ++x)
            at(x, y, z) = palette[static_cast<std::size_t>((a * x + b * y + c * z) / thick % std::ssize(palette))];
      break;
    }
    default:
      for (std::int64_t box = pick(1, 6); box > 0; --box) {
        const std::uint32_t label = any();
        std::array<std::int64_t, 3> low{}, high{};
        for (std::size_t i = 0; i < 3; ++i) {
          low[i] = pick(0, size[i] - 1);
          high[i] = pick(low[i] + 1, size[i]);
          if (pick(0, 2) == 0) low[i] &= ~std::int64_t{3};  // whole bricks
        }
        for (std::int64_t z = low[2]; z < high[2]; ++z)
          for (std::int64_t y = low[1]; y < high[1]; ++y)
            for (std::int64_t x = low[0]; x < high[0]; ++x) at(x, y, z) = label;
      }
  }
  return labels;
}

}  // namespace blackleaf::reference
