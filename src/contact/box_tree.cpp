#include "box_tree.h"

#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "blackleaf/error.h"
#include "contact_node.h"

namespace blackleaf {
namespace detail {
namespace {

// A box of voxels, [low, high), and how many of them are black.
struct Part {
  std::array<std::int32_t, 3> low{}, high{};
  std::uint64_t black = 0;
  std::uint32_t children = 0;
  std::array<double, 3> normal{};  // of any length: normal.x <= reach, x in voxels of the universe
  double reach = 0;

  bool is_full() const {
    std::uint64_t all = 1;
    for (std::size_t i = 0; i < 3; ++i) all *= static_cast<std::uint64_t>(high[i] - low[i]);
    return black == all;
  }
  BoxNode node() const {
    BoxNode node;
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      node.centre[i] = static_cast<float>((low[i] + high[i]) * 0.5);
      node.half[i] = static_cast<float>((high[i] - low[i]) * 0.5);
      squared += double{node.half[i]} * double{node.half[i]};
    }
    node.radius = std::nextafter(static_cast<float>(std::sqrt(squared)), std::numeric_limits<float>::infinity());
    node.children = children;
    add_plane(node);
    return node;
  }

  void add_plane(BoxNode& node) const {
    const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    if (children == 0 || length == 0) return;
    double from_centre = reach, box = 0;
    std::array<float, 3> unit{};
    for (std::size_t i = 0; i < 3; ++i) {
      from_centre -= normal[i] * double{node.centre[i]};
      unit[i] = static_cast<float>(normal[i] / length);
      box += std::abs(double{unit[i]}) * double{node.half[i]};
    }
    // The normal is off by 2^-24 on each axis, and this is rounded once more.
    const double rounded = from_centre / length + 0x1p-21 * double{node.radius};
    if (rounded >= box) return;  // the box is as close
    node.normal = unit;
    node.reach = std::nextafter(static_cast<float>(rounded), std::numeric_limits<float>::infinity());
  }
};

// A box in the cube of 2^3 voxels, as the byte of its voxels and its corners.
struct SmallBox {
  unsigned voxels = 0;
  std::array<std::int8_t, 3> low{}, high{};
};

// The 27 boxes of a cube of 2^3 voxels, the largest first.
constexpr std::array<SmallBox, 27> kSmallBoxes = [] {
  std::array<SmallBox, 27> boxes{};
  std::size_t count = 0;
  for (int size = 8; size >= 1; size /= 2)
    for (int kind = 0; kind < 27; ++kind) {
      SmallBox box;
      int volume = 1, rest = kind;
      for (std::size_t i = 0; i < 3; ++i, rest /= 3) {
        box.low[i] = rest % 3 == 1 ? 1 : 0;
        box.high[i] = rest % 3 == 0 ? 1 : 2;
        volume *= box.high[i] - box.low[i];
      }
      if (volume != size) continue;
      for (unsigned octant = 0; octant < 8; ++octant) {
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const int at = static_cast<int>(octant >> i & 1);
          inside = inside && box.low[i] <= at && at < box.high[i];
        }
        if (inside) box.voxels |= 1U << octant;
      }
      boxes[count++] = box;
    }
  return boxes;
}();

class Builder {
 public:
  Builder(const ContactNodes& source, std::vector<BoxNode>& nodes) : source_(source), nodes_(nodes) {}

  Part part(const ContactNode& node) {
    if (node.black) {
      Part full{node.corner, node.corner, std::uint64_t{1} << (3 * node.level), 0, {}, 0};
      for (auto& high : full.high) high += node.side();
      return full;
    }
    const std::size_t before = nodes_.size();
    std::array<Part, 8> parts;
    std::size_t count = 0;
    if (node.level == 1) {
      count = byte_parts(static_cast<unsigned>(node.word), node.corner, parts);
    } else {
      const ChildBoxes boxes = ContactNodes::boxes(node);
      for (unsigned rest = node.filled(); rest != 0; rest &= rest - 1)
        parts[count++] = part(source_.child(node, boxes, static_cast<std::size_t>(std::countr_zero(rest))));
    }
    if (count == 1) return parts[0];
    Part whole = parts[0];
    whole.black = node.level == 1 ? static_cast<unsigned>(std::popcount(node.word & 0xFF)) : 0;
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t i = 0; i < 3; ++i) {
        whole.low[i] = std::min(whole.low[i], parts[p].low[i]);
        whole.high[i] = std::max(whole.high[i], parts[p].high[i]);
      }
      if (node.level > 1) whole.black += parts[p].black;
    }
    whole.children = 0;
    if (whole.is_full()) {
      nodes_.resize(before);
      return whole;
    }
    if (nodes_.size() >= (std::size_t{1} << 28) - 8)
      throw Error(ErrorCode::bad_argument, "the solid has more than 2^28 boxes", "build it with a smaller depth");
    whole.children = static_cast<std::uint32_t>(nodes_.size() << 4 | count);
    whole.reach = double{node.reach};
    for (std::size_t i = 0; i < 3; ++i) {
      whole.normal[i] = double{node.normal[i]};
      whole.reach += whole.normal[i] * node.corner[i];
    }
    for (std::size_t p = 0; p < count; ++p) nodes_.push_back(parts[p].node());
    return whole;
  }

 private:
  // Boxes whose union is the byte's voxels; they may overlap.
  static std::size_t byte_parts(unsigned bits, const std::array<std::int32_t, 3>& corner, std::array<Part, 8>& parts) {
    std::size_t count = 0;
    unsigned left = bits & 0xFF;
    for (const SmallBox& box : kSmallBoxes) {
      if ((box.voxels & ~bits) != 0 || (box.voxels & left) == 0) continue;
      left &= ~box.voxels;
      Part& part = parts[count++];
      for (std::size_t i = 0; i < 3; ++i) {
        part.low[i] = corner[i] + box.low[i];
        part.high[i] = corner[i] + box.high[i];
      }
      part.black = static_cast<unsigned>(std::popcount(box.voxels));
      part.children = 0;
    }
    return count;
  }

  const ContactNodes& source_;
  std::vector<BoxNode>& nodes_;
};

}  // namespace

BoxTree::BoxTree(const PreparedSolid& solid) : depth(solid.depth()) {
  if (solid.is_empty()) return;
  const ContactNodes source(solid);
  nodes.push_back(Builder(source, nodes).part(source.root()).node());
  nodes.shrink_to_fit();
}

const BoxTree& boxes(const PreparedSolid& solid) {
  const PreparedSolid::Storage& storage = solid.storage();
  std::call_once(storage.boxes_made, [&] { storage.boxes = std::make_unique<const BoxTree>(solid); });
  return *storage.boxes;
}

}  // namespace detail
}  // namespace blackleaf
