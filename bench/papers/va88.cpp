#include "papers/va88.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <list>
#include <memory>
#include <optional>

#include "blackleaf/leaves.h"

namespace blackleaf::papers::va88 {
namespace {

using Place = std::array<std::int32_t, 3>;

// The octree with its octants relabelled so that the viewer is in the positive octant.
struct OctNode {
  Colour colour = Colour::white;
  std::array<std::unique_ptr<OctNode>, 8> children;
};

class RelabelledTree {
 public:
  RelabelledTree(const Octree& octree, const Eigen::Vector3d& direction) : side_(octree.side()) {
    for (const Leaf& leaf : black_leaves(octree)) {
      Place at = {leaf.cube.x, leaf.cube.y, leaf.cube.z};
      for (std::size_t i = 0; i < 3; ++i)
        if (direction[static_cast<int>(i)] < 0) at[i] = side_ - at[i] - leaf.cube.side();
      insert(at, leaf.cube.side());
    }
  }

  const OctNode& root() const { return root_; }
  std::int32_t side() const { return side_; }

  /// The node of the given size at a place, or the leaf that holds it; white outside the universe.
  const OctNode& find(const Place& at, std::int32_t size) const {
    static const OctNode outside;
    for (const std::int32_t x : at)
      if (x < 0 || x >= side_) return outside;
    const OctNode* node = &root_;
    for (std::int32_t half = side_ / 2; half >= size && node->colour == Colour::gray; half /= 2) {
      const auto& child = node->children[octant_of(at, half)];
      if (!child) return outside;
      node = child.get();
    }
    return *node;
  }

 private:
  static std::size_t octant_of(const Place& at, std::int32_t half) {
    return (at[0] & half ? 1u : 0u) | (at[1] & half ? 2u : 0u) | (at[2] & half ? 4u : 0u);
  }

  void insert(const Place& at, std::int32_t size) {
    OctNode* node = &root_;
    for (std::int32_t half = side_ / 2; half >= size && half > 0; half /= 2) {
      node->colour = Colour::gray;
      auto& child = node->children[octant_of(at, half)];
      if (!child) child = std::make_unique<OctNode>();
      node = child.get();
    }
    node->colour = Colour::black;
  }

  std::int32_t side_;
  OctNode root_;
};

// A visible segment of an edge: distances from the edge's beginning.
struct Edge {
  double min, max;
};

// One of the potentially visible edges of a box.
struct BoxEdge {
  std::size_t axis;
  Place origin;                // where it begins
  std::array<bool, 3> high{};  // on the box's upper side along the other axes?
  Eigen::Vector2d on_screen;   // projection of `origin`
  std::list<Edge> segments;
};

// Where a face that the line of sight runs along is covered by a black neighbour: intervals on the face's picture.
struct Seam {
  std::size_t axis;  // the face's normal
  bool high;
  std::vector<Edge> covered;
};

// The graphics node.
struct Box {
  Place origin;  // the corner farthest from the viewer
  std::int32_t len;
  Eigen::Vector2d corner;     // projection of `origin`
  Eigen::Vector2d low, high;  // bounds of the projection
  std::vector<BoxEdge> edges;
  std::vector<Seam> seams;
};

// A side of the projected unit cube at the origin: points p with normal . p >= offset lie outside.
struct Side {
  Eigen::Vector2d normal;
  double offset;
};

class Screen {
 public:
  explicit Screen(const Eigen::Vector3d& direction, double universe) {
    const Eigen::Vector3d d = direction.normalized();
    const Eigen::Vector3d up = d[0] == 0 && d[1] == 0 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d u = up.cross(d).normalized(), v = d.cross(u);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<int>(i);
      toward_[i] = std::abs(d[k]);
      axes_[i] = Eigen::Vector2d(u[k], v[k]);
      if (d[k] < 0) {  // relabelled: x' = side - x
        origin_ += universe * axes_[i];
        axes_[i] = -axes_[i];
      }
    }
    find_sides();
  }

  Eigen::Vector2d operator()(const Place& p) const {
    return origin_ + p[0] * axes_[0] + p[1] * axes_[1] + p[2] * axes_[2];
  }
  const Eigen::Vector2d& axis(std::size_t i) const { return axes_[i]; }
  bool shows(std::size_t axis) const { return toward_[axis] > 0; }  // the upper face along an axis
  bool is_general() const { return toward_[0] > 0 && toward_[1] > 0 && toward_[2] > 0; }
  const std::vector<Side>& sides() const { return sides_; }
  /// By how much a point comes nearer to each side's outside for one voxel along an axis.
  const std::array<double, 6>& slopes(std::size_t axis) const { return slopes_[axis]; }

 private:
  // The outline of the unit cube: a hexagon, or a rectangle when the viewer is in a coordinate plane. Each of its sides
  // is parallel to the picture of an axis, and has all eight corners on one hand.
  void find_sides() {
    for (const Eigen::Vector2d& axis : axes_) {
      if (axis.norm() < 1e-12) continue;
      for (const double turn : {-1.0, 1.0}) {
        const Eigen::Vector2d normal = turn * Eigen::Vector2d(-axis[1], axis[0]).normalized();
        double offset = 0;
        for (const Eigen::Vector2d& other : axes_) offset += std::max(0.0, normal.dot(other));
        const auto same = [&](const Side& side) { return (side.normal - normal).norm() < 1e-12; };
        if (std::none_of(sides_.begin(), sides_.end(), same)) sides_.push_back({normal, offset});
      }
    }
    assert(sides_.size() == 4 || sides_.size() == 6);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < sides_.size(); ++k) slopes_[axis][k] = sides_[k].normal.dot(axes_[axis]);
  }

  std::array<Eigen::Vector2d, 3> axes_;
  std::array<double, 3> toward_{};
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  std::vector<Side> sides_;
  std::array<std::array<double, 6>, 3> slopes_{};
};

class Drawer {
 public:
  Drawer(const Octree& octree, const Eigen::Vector3d& direction, Comparing comparing)
      : tree_(octree, direction),
        screen_(direction, octree.side()),
        comparing_(comparing),
        epsilon_(1e-10 * octree.side()) {}

  Drawing run() {
    traverse(tree_.root(), {0, 0, 0}, tree_.side());
    remove_hidden_lines();
    drawing_.graphics_nodes = boxes_.size();
    join();
    return std::move(drawing_);
  }

 private:
  // --- Traversal: octants nearest to the viewer first. Of two octants one of which can hide the other, the hiding one
  // has all the label bits of the other and more, so decreasing labels will do.
  void traverse(const OctNode& node, const Place& at, std::int32_t size) {
    if (node.colour == Colour::white) return;
    if (node.colour == Colour::black) {
      add_box(at, size);
      return;
    }
    for (int octant = 7; octant >= 0; --octant) {
      const auto& child = node.children[static_cast<std::size_t>(octant)];
      const std::int32_t half = size / 2;
      if (child)
        traverse(*child, {at[0] + (octant & 1) * half, at[1] + (octant >> 1 & 1) * half, at[2] + (octant >> 2) * half},
                 half);
    }
  }

  void add_box(const Place& at, std::int32_t size) {
    Box box{at, size, screen_(at), {}, {}, {}, {}};
    bool surrounded = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const bool high : {false, true}) {
        Place beside = at;
        beside[axis] += high ? size : -size;
        std::vector<std::pair<Place, std::int32_t>> covered;
        cover(beside, size, axis, high, covered);
        std::int64_t area = 0;
        for (const auto& square : covered) area += static_cast<std::int64_t>(square.second) * square.second;
        surrounded = surrounded && area == static_cast<std::int64_t>(size) * size;
        if (!screen_.shows(axis) && !covered.empty()) box.seams.push_back({axis, high, on_line(covered, axis)});
      }
    // A surrounded box is hidden, and hides nothing that the boxes before it do not hide; but its seams are its own.
    if (surrounded && screen_.is_general()) return;
    box.low = box.high = box.corner;
    for (std::size_t i = 0; i < 3; ++i) {
      box.low += (size * screen_.axis(i)).cwiseMin(0);
      box.high += (size * screen_.axis(i)).cwiseMax(0);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (unsigned side = 0; side < 4; ++side) add_edge(box, axis, side & 1, side & 2);
    boxes_.push_back(std::move(box));
  }

  // The squares of a face that have black on the other side: [at, at + size) is the cube there, `high` the side of the
  // box that it touches.
  void cover(const Place& at, std::int32_t size, std::size_t axis, bool high,
             std::vector<std::pair<Place, std::int32_t>>& squares) const {
    const Colour colour = tree_.find(at, size).colour;
    if (colour == Colour::black) {
      squares.emplace_back(at, size);
    } else if (colour == Colour::gray) {
      const std::int32_t half = size / 2;
      for (unsigned octant = 0; octant < 8; ++octant) {
        if ((octant >> axis & 1) == (high ? 1u : 0u)) continue;  // of the cube's own faces, the one toward the box
        cover({at[0] + (octant & 1 ? half : 0), at[1] + (octant & 2 ? half : 0), at[2] + (octant & 4 ? half : 0)}, half,
              axis, high, squares);
      }
    }
  }

  // The direction of the picture of a face along the line of sight: across the picture of its normal.
  Eigen::Vector2d line_of(std::size_t normal) const {
    const Eigen::Vector2d& axis = screen_.axis(normal);
    return Eigen::Vector2d(-axis[1], axis[0]).normalized();
  }

  std::vector<Edge> on_line(const std::vector<std::pair<Place, std::int32_t>>& squares, std::size_t normal) const {
    const Eigen::Vector2d line = line_of(normal);
    std::vector<Edge> intervals;
    for (const auto& [at, size] : squares) {
      Edge interval{line.dot(screen_(at)), line.dot(screen_(at))};
      for (std::size_t i = 0; i < 3; ++i) {
        const double extent = size * line.dot(screen_.axis(i));
        (extent < 0 ? interval.min : interval.max) += extent;
      }
      intervals.push_back(interval);
    }
    return intervals;
  }

  // --- Cracks. Only edges of faces that the viewer sees can be visible: nine of a hexagon.
  void add_edge(Box& box, std::size_t axis, bool high_b, bool high_c) const {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    if (!(high_b && screen_.shows(b)) && !(high_c && screen_.shows(c))) return;
    BoxEdge edge;
    edge.axis = axis;
    edge.origin = box.origin;
    if (high_b) edge.origin[b] += box.len;
    if (high_c) edge.origin[c] += box.len;
    edge.high[b] = high_b;
    edge.high[c] = high_c;
    edge.on_screen = screen_(edge.origin);
    keep_features(edge, edge.origin, box.len);
    if (!edge.segments.empty()) box.edges.push_back(std::move(edge));
  }

  // Adds the parts of [at, at + size) along the edge whose four neighbours do not make a smooth surface there.
  void keep_features(BoxEdge& edge, const Place& at, std::int32_t size) const {
    const std::size_t b = (edge.axis + 1) % 3, c = (edge.axis + 2) % 3;
    std::array<std::array<bool, 2>, 2> black{};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        Place beside = at;
        if (i == 0) beside[b] -= size;
        if (j == 0) beside[c] -= size;
        const Colour colour = tree_.find(beside, size).colour;
        if (colour == Colour::gray) {
          Place middle = at;
          middle[edge.axis] += size / 2;
          keep_features(edge, at, size / 2);
          keep_features(edge, middle, size / 2);
          return;
        }
        black[i][j] = colour == Colour::black;
      }
    if (black[0] == black[1] || (black[0][0] == black[0][1] && black[1][0] == black[1][1])) return;
    const double min = at[edge.axis] - edge.origin[edge.axis];
    if (!edge.segments.empty() && edge.segments.back().max == min)
      edge.segments.back().max += size;
    else
      edge.segments.push_back({min, min + size});
  }

  // --- Hidden lines: every box against all boxes before it.
  void remove_hidden_lines() {
    for (std::size_t later = 0; later < boxes_.size(); ++later)
      for (std::size_t earlier = 0; earlier < later; ++earlier) {
        ++drawing_.comparisons;
        const Box& x = boxes_[earlier];
        if (comparing_ == Comparing::extents && apart(x, boxes_[later])) continue;
        for (BoxEdge& edge : boxes_[later].edges) hide(edge, x);
      }
  }

  bool apart(const Box& x, const Box& y) const {
    const Eigen::Array2d margin(epsilon_, epsilon_);
    return (x.low.array() > y.high.array() + margin).any() || (y.low.array() > x.high.array() + margin).any();
  }

  void hide(BoxEdge& edge, const Box& by) {
    for (auto segment = edge.segments.begin(); segment != edge.segments.end();) {
      const auto next = std::next(segment);
      ++drawing_.edge_clippings;
      if (const auto hidden = clip(edge, *segment, by)) remove(edge, segment, *hidden);
      segment = next;
    }
    for (const Seam& seam : by.seams) hide(edge, by, seam);
  }

  // The part of a segment inside the projection of a box (modified Cohen-Sutherland): a bit of a code is set for each
  // side that the point is not strictly within.
  std::optional<Edge> clip(const BoxEdge& edge, const Edge& segment, const Box& by) const {
    const auto& sides = screen_.sides();
    const auto& slopes = screen_.slopes(edge.axis);
    std::array<double, 6> at_min{}, at_max{};
    unsigned code_min = 0, code_max = 0;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const double begin = sides[k].normal.dot(edge.on_screen - by.corner) - sides[k].offset * by.len;
      at_min[k] = begin + segment.min * slopes[k];
      at_max[k] = begin + segment.max * slopes[k];
      code_min |= (at_min[k] >= -epsilon_ ? 1u : 0u) << k;
      code_max |= (at_max[k] >= -epsilon_ ? 1u : 0u) << k;
    }
    if (code_min & code_max) return std::nullopt;    // wholly outside
    if ((code_min | code_max) == 0) return segment;  // wholly inside
    Edge inside = segment;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (!((code_min | code_max) >> k & 1)) continue;
      const double crossing = segment.min + (segment.max - segment.min) * at_min[k] / (at_min[k] - at_max[k]);
      if (code_min >> k & 1)
        inside.min = std::max(inside.min, crossing);
      else
        inside.max = std::min(inside.max, crossing);
    }
    if (inside.max - inside.min <= epsilon_) return std::nullopt;
    return inside;
  }

  // An edge that runs along the border of an earlier box on its own side is hidden where a black neighbour covers the
  // face behind that border: there the line of sight runs between two blacks.
  void hide(BoxEdge& edge, const Box& by, const Seam& seam) const {
    if (edge.axis == seam.axis || edge.high[seam.axis] != seam.high) return;
    if (edge.origin[seam.axis] != by.origin[seam.axis] + (seam.high ? by.len : 0)) return;
    const Eigen::Vector2d line = line_of(seam.axis);
    const double begin = line.dot(edge.on_screen), slope = line.dot(screen_.axis(edge.axis));
    for (const Edge& covered : seam.covered) {
      double low = (covered.min - begin) / slope, high = (covered.max - begin) / slope;
      if (low > high) std::swap(low, high);
      for (auto segment = edge.segments.begin(); segment != edge.segments.end();) {
        const auto next = std::next(segment);
        const Edge hidden{std::max(low, segment->min), std::min(high, segment->max)};
        if (hidden.max - hidden.min > epsilon_) remove(edge, segment, hidden);
        segment = next;
      }
    }
  }

  void remove(BoxEdge& edge, std::list<Edge>::iterator segment, const Edge& hidden) const {
    const Edge before{segment->min, hidden.min}, after{hidden.max, segment->max};
    if (before.max - before.min > epsilon_) edge.segments.insert(segment, before);
    if (after.max - after.min > epsilon_) edge.segments.insert(segment, after);
    edge.segments.erase(segment);
  }

  // --- Dots: contiguous segments of one line of the picture become one.
  struct OnLine {
    double offset, min, max;
  };

  void join() {
    std::array<bool, 3> done{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (done[axis] || screen_.axis(axis).norm() < 1e-12) continue;
      const Eigen::Vector2d along = screen_.axis(axis).normalized(), across(-along[1], along[0]);
      std::vector<OnLine> found;
      for (std::size_t other = axis; other < 3; ++other) {
        const Eigen::Vector2d& parallel = screen_.axis(other);
        if (parallel.norm() < 1e-12 || std::abs(across.dot(parallel)) > 1e-12) continue;
        done[other] = true;
        collect(other, along, across, found);
      }
      join_lines(found, along, across);
    }
  }

  void collect(std::size_t axis, const Eigen::Vector2d& along, const Eigen::Vector2d& across,
               std::vector<OnLine>& found) const {
    const double slope = along.dot(screen_.axis(axis));
    for (const Box& box : boxes_)
      for (const BoxEdge& edge : box.edges) {
        if (edge.axis != axis) continue;
        for (const Edge& segment : edge.segments) {
          const double begin = along.dot(edge.on_screen);
          const double one = begin + slope * segment.min, end = begin + slope * segment.max;
          found.push_back({across.dot(edge.on_screen), std::min(one, end), std::max(one, end)});
        }
      }
  }

  void join_lines(std::vector<OnLine>& found, const Eigen::Vector2d& along, const Eigen::Vector2d& across) {
    const double near = 10 * epsilon_;  // offsets of one line differ by rounding only
    std::sort(found.begin(), found.end(), [](const OnLine& p, const OnLine& q) { return p.offset < q.offset; });
    for (auto begin = found.begin(); begin != found.end();) {
      auto end = std::next(begin);
      while (end != found.end() && end->offset - std::prev(end)->offset <= near) ++end;
      std::sort(begin, end, [](const OnLine& p, const OnLine& q) { return p.min < q.min; });
      for (auto i = begin; i != end;) {
        OnLine joined = *i;
        for (++i; i != end && i->min <= joined.max + near; ++i) joined.max = std::max(joined.max, i->max);
        const Eigen::Vector2d foot = joined.offset * across;
        drawing_.segments.push_back({foot + joined.min * along, foot + joined.max * along});
      }
      begin = end;
    }
  }

  RelabelledTree tree_;
  Screen screen_;
  Comparing comparing_;
  double epsilon_;  // voxels: what counts as nothing
  std::vector<Box> boxes_;
  Drawing drawing_;
};

}  // namespace

double Drawing::length() const {
  double sum = 0;
  for (const Segment& segment : segments) sum += (segment.to - segment.from).norm();
  return sum;
}

Drawing draw(const Octree& octree, const Eigen::Vector3d& direction, Comparing comparing) {
  assert(direction.allFinite() && !direction.isZero(0));
  return Drawer(octree, direction, comparing).run();
}

}  // namespace blackleaf::papers::va88
