#include "stretch.h"

#include <algorithm>
#include <cassert>

#include "octree/node_arrays.h"

namespace blackleaf::mpi {
namespace {

using detail::LevelWords;
using detail::NodeArrays;
using detail::Subtree;

__extension__ using Wide = unsigned __int128;  // 2^60 voxels times processes

VoxelBox common(const Cube& cube, const VoxelBox& box) {
  const std::array<std::int64_t, 3> corner = {cube.x, cube.y, cube.z};
  VoxelBox result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.low[i] = std::max(corner[i], box.low[i]);
    result.high[i] = std::max(result.low[i], std::min(corner[i] + cube.side(), box.high[i]));
  }
  return result;
}

std::uint64_t share(const Cube& cube, const VoxelBox& box) {
  return static_cast<std::uint64_t>(common(cube, box).voxels());
}

// The number of the block before which there are about so many of the box's voxels.
std::uint64_t number_at(int depth, const VoxelBox& box, std::uint64_t voxels) {
  Cube cube{0, 0, 0, depth};
  std::uint8_t table = 0;
  std::uint64_t first = 0;
  while (cube.level > kBlockLevel) {
    const std::uint64_t step = voxels_of(cube.level - 1);
    for (std::size_t i = 0; i < 8; ++i, first += step) {
      const curve::Step down = curve::kSteps[table][i];
      const Cube child = cube.child(down.octant);
      const std::uint64_t here = share(child, box);
      if (voxels < here || i == 7) {
        cube = child;
        table = down.table;
        break;
      }
      voxels -= here;
    }
  }
  return 2 * voxels < share(cube, box) ? first : first + voxels_of(cube.level);
}

// Calls visit(cube) for the largest nodes of a stretch.
template <class Visit>
void for_each_node(const Cube& cube, std::uint8_t table, std::uint64_t first, const Stretch& stretch,
                   const Visit& visit) {
  const std::uint64_t end = first + voxels_of(cube.level);
  if (end <= stretch.first || first >= stretch.last) return;
  if (first >= stretch.first && end <= stretch.last) {
    visit(cube);
    return;
  }
  const std::uint64_t step = voxels_of(cube.level - 1);
  for (const curve::Step down : curve::kSteps[table]) {
    for_each_node(cube.child(down.octant), down.table, first, stretch, visit);
    first += step;
  }
}

// Whether two boxes are one; if so, the first becomes it.
bool unite(VoxelBox& a, const VoxelBox& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (a.low[u] != b.low[u] || a.high[u] != b.high[u] || a.low[v] != b.low[v] || a.high[v] != b.high[v]) continue;
    if (a.high[axis] != b.low[axis] && b.high[axis] != a.low[axis]) continue;
    a.low[axis] = std::min(a.low[axis], b.low[axis]);
    a.high[axis] = std::max(a.high[axis], b.high[axis]);
    return true;
  }
  return false;
}

Subtree cut_out(const Node& node, std::uint8_t table, std::uint64_t first, const Stretch& stretch,
                const LevelWords& words, NodeArrays& arrays) {
  const std::uint64_t end = first + voxels_of(node.level());
  if (node.is_white() || end <= stretch.first || first >= stretch.last) return Subtree::uniform(Colour::white);
  if (first >= stretch.first && end <= stretch.last) {
    if (!node.is_gray()) return Subtree::uniform(node.colour());
    if (node.level() == 2) return Subtree::brick(node.word());
    return arrays.copy(words, node.word(), node.level(), false);
  }
  assert(node.level() > 2);
  std::array<Subtree, 8> children;
  const std::uint64_t step = voxels_of(node.level() - 1);
  for (const curve::Step down : curve::kSteps[table]) {
    children[down.octant] = cut_out(node.child(down.octant), down.table, first, stretch, words, arrays);
    first += step;
  }
  return arrays.close(node.level(), children);
}

struct Piece {
  Node node;
  const LevelWords* words;
};

Subtree joined(std::vector<Piece> pieces, int level, std::uint8_t table, NodeArrays& arrays) {
  std::erase_if(pieces, [](const Piece& piece) { return piece.node.is_white(); });
  if (pieces.empty()) return Subtree::uniform(Colour::white);
  if (pieces.front().node.is_black()) return Subtree::uniform(Colour::black);
  if (level == 2) {
    std::uint64_t bits = 0;
    for (const Piece& piece : pieces) bits |= piece.node.brick();
    return Subtree::brick(bits);
  }
  if (pieces.size() == 1) return arrays.copy(*pieces.front().words, pieces.front().node.word(), level, false);
  std::array<Subtree, 8> children;
  for (const curve::Step down : curve::kSteps[table]) {
    std::vector<Piece> below = pieces;
    for (Piece& piece : below) piece.node = piece.node.child(down.octant);
    children[down.octant] = joined(std::move(below), level - 1, down.table, arrays);
  }
  return arrays.close(level, children);
}

}  // namespace

int process_at(const Cuts& cuts, std::uint64_t number) {
  return static_cast<int>(std::upper_bound(cuts.begin(), cuts.end() - 1, number) - cuts.begin()) - 1;
}

Cuts uncut(int depth, int processes) {
  Cuts cuts(static_cast<std::size_t>(processes) + 1, voxels_of(depth));
  cuts.front() = 0;
  return cuts;
}

Cuts cuts_by_voxels(int depth, const VoxelBox& box, int processes) {
  if (depth <= kBlockLevel) return uncut(depth, processes);
  Cuts cuts = uncut(depth, processes);
  const auto all = static_cast<Wide>(box.voxels());
  for (std::size_t i = 1; i + 1 < cuts.size(); ++i)
    cuts[i] = number_at(depth, box, static_cast<std::uint64_t>(all * i / static_cast<unsigned>(processes)));
  return cuts;
}

std::vector<VoxelBox> boxes_of(int depth, const Stretch& stretch, const VoxelBox& box) {
  std::vector<VoxelBox> boxes;
  for_each_node({0, 0, 0, depth}, 0, 0, stretch, [&](const Cube& cube) {
    const VoxelBox here = common(cube, box);
    if (here.voxels() == 0) return;
    boxes.push_back(here);
    // A box that has grown may now fit another.
    for (std::size_t last = boxes.size() - 1, i = 0; i < last;) {
      if (unite(boxes[i], boxes[last])) {
        boxes[last] = boxes[i];
        boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
        --last;
        i = 0;
      } else {
        ++i;
      }
    }
  });
  return boxes;
}

Cuts cuts_by_weight(int depth, std::span<const std::uint64_t> numbers, std::span<const std::uint64_t> weights,
                    int processes) {
  assert(!numbers.empty() && numbers.size() == weights.size());
  Cuts cuts = uncut(depth, processes);
  Wide all = 0;
  for (const std::uint64_t weight : weights) all += weight;
  Wide before = 0;  // the weight of the units before this
  std::size_t unit = 0;
  for (std::size_t i = 1; i + 1 < cuts.size(); ++i) {
    const Wide wanted = all * i / static_cast<unsigned>(processes);
    // A unit belongs to whoever has its middle.
    while (unit < numbers.size() && 2 * before + weights[unit] <= 2 * wanted) before += weights[unit++];
    cuts[i] = unit == 0 ? 0 : unit < numbers.size() ? numbers[unit] : voxels_of(depth);
  }
  return cuts;
}

Octree part_of(const Octree& octree, const Stretch& stretch) {
  if (stretch == whole(octree.depth())) return octree;
  if (stretch.empty() || octree.is_empty()) return Octree(octree.depth(), Colour::white, octree.frame());
  NodeArrays arrays;
  const Subtree top = cut_out(octree.root(), 0, 0, stretch, detail::level_words(octree), arrays);
  return arrays.finish(octree.depth(), top, octree.frame());
}

Octree join(std::span<const Octree> parts) {
  assert(!parts.empty());
  const int depth = parts.front().depth();
  std::vector<LevelWords> words;
  words.reserve(parts.size());  // pieces point into it
  std::vector<Piece> pieces;
  for (const Octree& part : parts) {
    assert(part.depth() == depth);
    if (part.is_empty()) continue;
    words.push_back(detail::level_words(part));
    pieces.push_back({part.root(), &words.back()});
    if (pieces.size() == 1 && parts.size() == 1) return part;
  }
  if (pieces.empty()) return parts.front();
  if (pieces.size() == 1)
    return std::find_if(parts.begin(), parts.end(), [](const Octree& part) { return !part.is_empty(); })
        ->with_frame(parts.front().frame());
  assert(depth >= 2);
  NodeArrays arrays;
  const Subtree top = joined(std::move(pieces), depth, 0, arrays);
  return arrays.finish(depth, top, parts.front().frame());
}

}  // namespace blackleaf::mpi
