#include "touched.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "octree/node_arrays.h"
#include "octree/produce.h"

namespace blackleaf::detail {
namespace {

// A direction along which a triangle and an upright cube may be separated: the triangle spans [low, high] on it, a cube
// with corner c and side s spans n.c + s [negative, positive]. The sets are closed; they are separated only if the
// spans are disjoint.
struct Axis {
  std::array<Wide, 3> n{};
  Wide low = 0, high = 0, negative = 0, positive = 0;

  void close() {
    for (const Wide component : n) (component < 0 ? negative : positive) += component;
  }
  bool separates(const GridPoint& c, std::int64_t side) const {
    const Wide at = n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
    return at + positive * side < low || at + negative * side > high;
  }
};

// The ten such directions of a triangle that are not the cube's own: its normal, and its edges turned by a right angle
// in each of the three coordinate planes (their products with the cube's edges). A triangle and a box that no one of
// these and of the cube's three directions separates have a point in common: those are the normals of the faces of
// their Minkowski difference.
//
// Bounds: the normal's components are below 2^81 + 2^42, those of the other directions below 2^40 + 1; with coordinates
// and sides of at most 2^40 sums of up to four products stay below 2^124.
class TriangleAxes {
 public:
  TriangleAxes(const GridPoint& a, const GridPoint& b, const GridPoint& c) : p_{a, b, c} {
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = std::min({a[i], b[i], c[i]});
      high_[i] = std::max({a[i], b[i], c[i]});
      axes_[0].n[i] = normal(a, b, c, i);
    }
    axes_[0].low = axes_[0].high = axes_[0].n[0] * a[0] + axes_[0].n[1] * a[1] + axes_[0].n[2] * a[2];
    std::size_t next = 1;
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const GridPoint &from = p_[edge], &to = p_[(edge + 1) % 3];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        Axis& axis = axes_[next++];
        axis.n[j] = to[k] - from[k];
        axis.n[k] = from[j] - to[j];
        const auto project = [&](const GridPoint& q) { return axis.n[j] * q[j] + axis.n[k] * q[k]; };
        const Wide on_edge = project(from), opposite = project(p_[(edge + 2) % 3]);
        axis.low = std::min(on_edge, opposite);
        axis.high = std::max(on_edge, opposite);
      }
    }
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      axes_[i].close();
      rounded_[i] = Rounded(axes_[i]);
    }
  }

  bool meets(const GridPoint& corner, std::int64_t side) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (corner[i] > high_[i] || corner[i] + side < low_[i]) return false;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const int verdict = rounded_[i].verdict(corner, static_cast<double>(side));
      if (verdict > 0 || (verdict == 0 && axes_[i].separates(corner, side))) return false;
    }
    return true;
  }

 private:
  // The same in floating point, where that is certain. All terms are at most `scale` in size, each with a relative
  // error of a few 2^-53; a dozen of them differ from the truth by less than 2^-47 scale.
  struct Rounded {
    std::array<double, 3> n{};
    double low = 0, high = 0, negative = 0, positive = 0, error = 0;

    Rounded() = default;
    explicit Rounded(const Axis& axis)
        : low(static_cast<double>(axis.low)),
          high(static_cast<double>(axis.high)),
          negative(static_cast<double>(axis.negative)),
          positive(static_cast<double>(axis.positive)) {
      for (std::size_t i = 0; i < 3; ++i) n[i] = static_cast<double>(axis.n[i]);
      // Coordinates and sides are at most 2^40, so this bounds every term, low and high included.
      error = 0x1p-47 * std::ldexp(positive - negative, kGridBits);
    }
    // 1: separates; -1: does not; 0: cannot tell.
    int verdict(const GridPoint& c, double side) const {
      const double at =
          n[0] * static_cast<double>(c[0]) + n[1] * static_cast<double>(c[1]) + n[2] * static_cast<double>(c[2]);
      const double above = low - (at + positive * side), below = (at + negative * side) - high;
      if (above > error || below > error) return 1;
      return above < -error && below < -error ? -1 : 0;
    }
  };

  std::array<GridPoint, 3> p_;
  GridPoint low_{}, high_{};
  std::array<Axis, 10> axes_;
  std::array<Rounded, 10> rounded_;
};

// Descends with the triangles that meet a node.
class TouchedProducer {
 public:
  struct Task {
    Node inside;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint8_t> children;  // by triangle: the octants of the node that it meets
  };

  TouchedProducer(const Octree& inside, const GridMesh& mesh) : inside_(inside), mesh_(mesh) {}

  Task root() const {
    Task task{brick_level_root(inside_), {}, {}};
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (normal(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], axis) != 0) {
          task.triangles.push_back(i);
          break;
        }
    }
    return task;
  }

  Colour classify(Task& task, const Cube& cube) const {
    assert(cube.level >= 2);
    if (!task.inside.is_gray() && (task.inside.is_black() || task.triangles.empty())) return task.inside.colour();
    if (cube.level > 2) {
      task.children.resize(task.triangles.size());
      for (std::size_t i = 0; i < task.triangles.size(); ++i)
        task.children[i] = octants(axes_of(task.triangles[i]), cube);
    }
    return Colour::gray;
  }

  Task child(const Task& task, const Cube&, int octant) const {
    Task below{task.inside.child(octant), {}, {}};
    for (std::size_t i = 0; i < task.triangles.size(); ++i)
      if (task.children[i] >> octant & 1) below.triangles.push_back(task.triangles[i]);
    return below;
  }

  std::uint64_t brick(const Task& task, const Cube& cube) const {
    std::uint64_t bits = task.inside.brick();
    for (const std::uint32_t i : task.triangles) {
      if (~bits == 0) break;
      const TriangleAxes axes = axes_of(i);
      const unsigned met = octants(axes, cube);
      for (int octant = 0; octant < 8; ++octant)
        if (met >> octant & 1 && (bits >> 8 * octant & 0xFF) != 0xFF)
          bits |= std::uint64_t{octants(axes, cube.child(octant))} << 8 * octant;
    }
    return bits;
  }

 private:
  TriangleAxes axes_of(std::uint32_t index) const {
    const Triangle& t = mesh_.triangles[index];
    return TriangleAxes(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  }

  // The children of a node that a triangle meets, by octant.
  std::uint8_t octants(const TriangleAxes& axes, const Cube& cube) const {
    unsigned met = 0;
    for (int octant = 0; octant < 8; ++octant) {
      const Cube child = cube.child(octant);
      const int bits = mesh_.fraction_bits();
      const GridPoint corner = {std::int64_t{child.x} << bits, std::int64_t{child.y} << bits,
                                std::int64_t{child.z} << bits};
      if (axes.meets(corner, std::int64_t{child.side()} << bits)) met |= 1u << octant;
    }
    return static_cast<std::uint8_t>(met);
  }

  const Octree& inside_;
  const GridMesh& mesh_;
};

}  // namespace

Octree with_touched(const Octree& inside, const GridMesh& mesh, const Work& work) {
  return produce(TouchedProducer(inside, mesh), inside.depth(), inside.frame(), work);
}

}  // namespace blackleaf::detail
