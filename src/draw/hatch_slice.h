// One hatch line: the slice of a scene by the plane of a line of the picture and the view direction, looked at from the
// viewer.
//
// Coordinates. Points of the picture are named by w.p and q.p, whole-number vectors with w.d = q.d = 0: the line is
// w.p = k with k = K / 512, K odd; q.p counts the position along it. A cube's picture is a hexagon, the sum of the
// three segments (side w_j, side q_j): on the line it covers an interval whose ends lie on images of the cube's edges.
// An edge along j crosses the line where q.p has the denominator 512 w_j, so positions are counted in 1 / (512 M), M
// the product of all |w_j| that are not 0, and are whole. As K is odd, no corner lies on the line.
//
// Bounds. |d_i| <= 2^20 and h_i in {-1, 0, 1}; n being the axis across the faces, |w_n| <= 2^21, the other |w_j| <=
// 2^20, |q_j| <= 2^20, M <= 2^61, |K| <= 2^52. Corners: |q.p| <= 2^42, times 512 M below 2^112. Along an edge: K q_j M
// / |w_j| below 2^52+20+41. So 128 bits hold all.
//
// The search. The tree is walked from the root, children nearest to the viewer first. What a box covers of what is
// still open is seen; the part of it in the picture of the box's face across n is a visible face.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "edge_family.h"
#include "motion/label_tree.h"
#include "visible_set.h"
#include "wide.h"

namespace blackleaf::detail {

struct WideInterval {
  Wide low, high;
};

/// What all hatch lines along one direction have in common.
struct HatchFamily {
  unsigned n;                     // the axis across the faces
  std::array<std::int64_t, 3> h;  // along the lines, in the faces
  Direction d, w, q;
  Wide unit = 512;                              // 512 M: positions are in 1 / unit of q.p
  std::array<Wide, 3> per_w{};                  // along an edge j: what q.p gains, in units, when 512 w.p gains 1
  std::array<unsigned, 3> rising{}, falling{};  // axes with w_j other than 0 by slope, lowest first and last
  unsigned slopes = 0;                          // how many
  std::array<unsigned, 2> face_rising{};        // the two of the face
  unsigned nearest = 0;                         // octant label of the child nearest to the viewer

  static Direction cross(const Direction& a, const Direction& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  /// Lines along e_b + e_c, or e_b - e_c if `leaning`, b and c the axes after n. Requires: d[n] is not 0.
  HatchFamily(unsigned across, bool leaning, const Direction& direction) : n(across), h{}, d(direction) {
    const unsigned b = (n + 1) % 3, c = (n + 2) % 3;
    h[b] = 1;
    h[c] = leaning ? -1 : 1;
    w = cross(h, d);
    const std::int64_t common = std::gcd(std::gcd(w[0], w[1]), w[2]);
    for (std::int64_t& component : w) component /= common;
    Direction axis{};
    axis[b] = 1;
    q = cross(axis, d);
    std::int64_t product = 1;
    for (const std::int64_t component : w) product *= component == 0 ? 1 : std::abs(component);
    unit = Wide{product} * 512;
    for (unsigned j = 0; j < 3; ++j) {
      if (d[j] > 0) nearest |= 1u << j;
      if (w[j] == 0) continue;
      per_w[j] = Wide{product / w[j]} * q[j];
      rising[slopes++] = j;
    }
    // Slopes q_j / w_j, over one denominator.
    std::sort(rising.begin(), rising.begin() + slopes, [&](unsigned i, unsigned j) { return per_w[i] < per_w[j]; });
    unsigned faces = 0;
    for (unsigned i = 0; i < slopes; ++i) {
      falling[i] = rising[slopes - 1 - i];
      if (rising[i] != n) face_rising[faces++] = rising[i];
    }
  }
};

/// A piece of a hatch line: what is seen there.
struct HatchPiece {
  Wide low, high;
  std::uint32_t label;
  friend bool operator<(const HatchPiece& a, const HatchPiece& b) { return a.low < b.low; }
};

/// Walks one line at a time.
class HatchSlice {
 public:
  HatchSlice(const LabelTree& tree, int depth, const HatchFamily& family)
      : tree_(tree), depth_(depth), family_(family) {}

  /// What is seen along the line w.p = line / 512 of faces across n, in increasing order: pieces with what
  /// `owner(label)` says of the box that they belong to, without those for which it says 0; those of one owner that
  /// touch are united. Requires: `line` is odd.
  template <class Owner>
  std::vector<HatchPiece> seen(std::int64_t line, const Owner& owner) {
    pieces_.clear();
    const WideInterval all = covered(depth_, line, 0, false);
    if (all.low >= all.high) return pieces_;
    open_.reset(all.low, all.high);
    descend(tree_.root(), depth_, line, 0);
    std::sort(pieces_.begin(), pieces_.end());
    std::size_t count = 0;
    for (HatchPiece piece : pieces_) {
      piece.label = owner(piece.label);
      if (piece.label == 0) continue;
      if (count > 0 && pieces_[count - 1].high == piece.low && pieces_[count - 1].label == piece.label)
        pieces_[count - 1].high = piece.high;
      else
        pieces_[count++] = piece;
    }
    pieces_.resize(count);
    return pieces_;
  }

 private:
  // What the line covers of the picture of a cube or, with `face`, of its lower face across n; empty if it passes by.
  // `line` and `at` are 512 w.p of the line less that of the cube's corner, and q.p of the corner in units.
  WideInterval covered(int level, std::int64_t line, Wide at, bool face) const {
    const HatchFamily& f = family_;
    const unsigned* order = face ? f.face_rising.data() : f.rising.data();
    const unsigned count = face ? 2 : f.slopes;
    Wide low_end = at;
    std::int64_t whole = 0;
    // To the corner where w.p is least.
    for (unsigned i = 0; i < count; ++i) {
      const unsigned j = order[i];
      const std::int64_t step = f.w[j] * 512 << level;
      if (step < 0) {
        line -= step;
        low_end += f.unit * f.q[j] << level;
        whole -= step;
      } else {
        whole += step;
      }
    }
    if (line <= 0 || line >= whole) return {0, 0};
    Wide high_end = low_end;
    if (!face && f.w[f.n] == 0) (f.q[f.n] < 0 ? low_end : high_end) += f.unit * f.q[f.n] << level;  // along the line
    return {along(level, line, low_end, order, count, false), along(level, line, high_end, order, count, true)};
  }

  // The position on the chain of edges from the corner where w.p is least, steepest edges first or last.
  Wide along(int level, std::int64_t line, Wide at, const unsigned* order, unsigned count, bool steepest_first) const {
    const HatchFamily& f = family_;
    for (unsigned i = 0;; ++i) {
      const unsigned j = order[steepest_first ? count - 1 - i : i];
      const std::int64_t step = std::abs(f.w[j]) * 512 << level;
      if (line < step) return at + f.per_w[j] * line;
      line -= step;
      at += f.per_w[j] * step;
    }
  }

  void descend(LabelTree::Node node, int level, std::int64_t line, Wide at) {
    const HatchFamily& f = family_;
    if (node.has_one_label() && node.label() == 0) return;
    const WideInterval covers = covered(level, line, at, false);
    if (covers.low >= covers.high || !open_.meets(covers.low, covers.high)) return;
    if (node.has_one_label()) {
      const bool upper = f.d[f.n] > 0;  // the face that is seen is the upper one
      const WideInterval face = covered(level, upper ? line - (f.w[f.n] * 512 << level) : line,
                                        upper ? at + (f.unit * f.q[f.n] << level) : at, true);
      for (const WideInterval& part : open_.intervals()) {
        const Wide low = std::max(part.low, face.low), high = std::min(part.high, face.high);
        if (low < high) pieces_.push_back({low, high, node.label()});
      }
      open_.subtract(covers.low, covers.high);
      return;
    }
    const int below = level - 1;
    for (unsigned i = 0; i < 8 && !open_.intervals().empty(); ++i) {
      const unsigned octant = f.nearest ^ i;
      std::int64_t child_line = line;
      Wide child_at = at;
      for (unsigned j = 0; j < 3; ++j) {
        if (!(octant >> j & 1)) continue;
        child_line -= f.w[j] * 512 << below;
        child_at += f.unit * f.q[j] << below;
      }
      descend(tree_.child(node, octant), below, child_line, child_at);
    }
  }

  const LabelTree& tree_;
  int depth_;
  const HatchFamily& family_;
  BasicVisibleSet<WideInterval> open_;
  std::vector<HatchPiece> pieces_;
};

}  // namespace blackleaf::detail
