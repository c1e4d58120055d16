#include "box_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace blackleaf::detail {
namespace {

using Eigen::Vector3d;

// A vertex of the difference b - a, and the vertex of a that it belongs to.
struct Vertex {
  Vector3d difference, on_a;
};

// The point of a simplex nearest to the origin, as weights of at most three of its vertices; four when it is the
// origin.
struct Simplex {
  std::array<Vertex, 4> vertices;
  std::array<double, 4> weights{};
  int count = 0;

  Vector3d point() const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < count; ++i)
      sum += weights[static_cast<std::size_t>(i)] * vertices[static_cast<std::size_t>(i)].difference;
    return sum;
  }
  Vector3d on_a() const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < count; ++i)
      sum += weights[static_cast<std::size_t>(i)] * vertices[static_cast<std::size_t>(i)].on_a;
    return sum;
  }
};

Simplex vertex(const Vertex& p) { return {{p}, {1}, 1}; }

Simplex nearest_on_edge(const Vertex& p, const Vertex& q) {
  const Vector3d along = q.difference - p.difference;
  const double dot = -p.difference.dot(along), squared = along.squaredNorm();
  if (dot <= 0) return vertex(p);
  if (dot >= squared) return vertex(q);
  const double t = dot / squared;
  return {{p, q}, {1 - t, t}, 2};
}

// Ericson, Real-Time Collision Detection, 5.1.5, with the origin as the point.
Simplex nearest_on_triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
  const Vector3d ab = b.difference - a.difference, ac = c.difference - a.difference;
  const double d1 = -ab.dot(a.difference), d2 = -ac.dot(a.difference);
  if (d1 <= 0 && d2 <= 0) return vertex(a);
  const double d3 = -ab.dot(b.difference), d4 = -ac.dot(b.difference);
  if (d3 >= 0 && d4 <= d3) return vertex(b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return nearest_on_edge(a, b);
  const double d5 = -ab.dot(c.difference), d6 = -ac.dot(c.difference);
  if (d6 >= 0 && d5 <= d6) return vertex(c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return nearest_on_edge(a, c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return nearest_on_edge(b, c);
  const double sum = va + vb + vc;
  return {{a, b, c}, {va / sum, vb / sum, vc / sum}, 3};
}

Simplex nearest_on(const Simplex& simplex) {
  const auto& v = simplex.vertices;
  if (simplex.count == 1) return vertex(v[0]);
  if (simplex.count == 2) return nearest_on_edge(v[0], v[1]);
  if (simplex.count == 3) return nearest_on_triangle(v[0], v[1], v[2]);
  constexpr std::array<std::array<std::size_t, 4>, 4> kFaces = {
      {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
  Simplex best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& face : kFaces) {
    const Vector3d &a = v[face[0]].difference, &b = v[face[1]].difference, &c = v[face[2]].difference;
    const Vector3d normal = (b - a).cross(c - a);
    const double origin = -normal.dot(a), opposite = normal.dot(v[face[3]].difference - a);
    // On the same side as the fourth vertex: not beyond this face.
    if (origin * opposite > 0) continue;
    const Simplex on_face = nearest_on_triangle(v[face[0]], v[face[1]], v[face[2]]);
    const double squared = on_face.point().squaredNorm();
    if (squared < least) {
      least = squared;
      best = on_face;
    }
  }
  if (best.count > 0) return best;
  // Inside: the origin itself, by the volumes opposite to each vertex.
  Simplex inside = simplex;
  double sum = 0;
  for (const auto& face : kFaces) {
    const double volume = std::abs(v[face[0]].difference.dot(v[face[1]].difference.cross(v[face[2]].difference)));
    inside.weights[face[3]] = volume;
    sum += volume;
  }
  for (double& weight : inside.weights) weight /= sum;
  return inside;
}

// Two boxes about the upright one's centre.
struct Pair {
  Vector3d half_a, half_b, shift;  // shift: the centre of b
  const Eigen::Matrix3d& f;

  Pair(const BoxNode& a, const BoxNode& b, const RigidMap& p)
      : half_a(half_of(a)),
        half_b(half_of(b)),
        shift(p.rotation * centre_of(b) + p.shift - centre_of(a)),
        f(p.rotation) {}

  double size() const { return shift.cwiseAbs().sum() + half_a.sum() + half_b.sum(); }

  Vector3d corner_of_a(const Vector3d& toward) const {
    return {std::copysign(half_a[0], toward[0]), std::copysign(half_a[1], toward[1]),
            std::copysign(half_a[2], toward[2])};
  }
  Vector3d corner_of_b(const Vector3d& toward) const {
    Vector3d corner = shift;
    for (int j = 0; j < 3; ++j) corner += f.col(j) * std::copysign(half_b[j], f.col(j).dot(toward));
    return corner;
  }
  // The vertex of b - a farthest against v.
  Vertex farthest_against(const Vector3d& v) const {
    const Vector3d a = corner_of_a(v);
    return {corner_of_b(-v) - a, a};
  }

  // Gap of the projections onto a direction of any length, times that length.
  double gap(const Vector3d& n) const {
    return std::abs(n.dot(shift)) - half_a.dot(n.cwiseAbs()) - half_b.dot((f.transpose() * n).cwiseAbs());
  }
};

double largest_gap(const Pair& pair) {
  double largest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) largest = std::max(largest, pair.gap(Vector3d::Unit(i)));
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    const Vector3d normal = pair.f.col(k).cross(pair.f.col(l)).normalized();
    largest = std::max(largest, pair.gap(normal));
  }
  // Edges that are parallel to 2^-20 add nothing but slivers of faces.
  constexpr double kParallel = 0x1p-40;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vector3d axis = Vector3d::Unit(i).cross(pair.f.col(j));
      const double squared = axis.squaredNorm();
      if (squared > kParallel) largest = std::max(largest, pair.gap(axis) / std::sqrt(squared));
    }
  return largest;
}

struct Segment {
  Vector3d from, along;
};

// Nearest points of two segments (Ericson, 5.1.9).
NearestPoints nearest_of_segments(const Segment& p, const Segment& q) {
  const Vector3d r = p.from - q.from;
  const double a = p.along.squaredNorm(), e = q.along.squaredNorm(), f = q.along.dot(r), c = p.along.dot(r),
               b = p.along.dot(q.along), denominator = a * e - b * b;
  double s = denominator > 0x1p-40 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  NearestPoints nearest;
  nearest.on_a = p.from + s * p.along;
  nearest.on_b = q.from + t * q.along;
  nearest.distance = (nearest.on_a - nearest.on_b).norm();
  return nearest;
}

// The twelve edges of the box centre +- columns.
std::array<Segment, 12> edges(const Vector3d& centre, const Eigen::Matrix3d& columns) {
  std::array<Segment, 12> result;
  std::size_t count = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double s : {-1.0, 1.0})
      for (const double t : {-1.0, 1.0})
        result[count++] = {
            centre - columns.col(axis) + s * columns.col((axis + 1) % 3) + t * columns.col((axis + 2) % 3),
            2 * columns.col(axis)};
  return result;
}

Vector3d corner(const Vector3d& half, unsigned which) {
  return {(which & 1) != 0 ? half[0] : -half[0], (which & 2) != 0 ? half[1] : -half[1],
          (which & 4) != 0 ? half[2] : -half[2]};
}

// All pairs of features: corners and boxes, edges and edges. For what does not overlap.
NearestPoints nearest_features(const Pair& pair) {
  NearestPoints best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vector3d& on_a, const Vector3d& on_b) {
    const double distance = (on_a - on_b).norm();
    if (distance < best.distance) best = {distance, on_a, on_b};
  };
  const Eigen::Matrix3d inverse = pair.f.inverse();
  for (unsigned which = 0; which < 8; ++which) {
    const Vector3d of_b = pair.shift + pair.f * corner(pair.half_b, which);
    offer(of_b.cwiseMax(-pair.half_a).cwiseMin(pair.half_a), of_b);
    const Vector3d of_a = corner(pair.half_a, which);
    const Vector3d inside = (inverse * (of_a - pair.shift)).cwiseMax(-pair.half_b).cwiseMin(pair.half_b);
    offer(of_a, pair.shift + pair.f * inside);
  }
  const auto of_a = edges(Vector3d::Zero(), pair.half_a.asDiagonal());
  const auto of_b = edges(pair.shift, pair.f * pair.half_b.asDiagonal());
  for (const Segment& p : of_a)
    for (const Segment& q : of_b) {
      const NearestPoints nearest = nearest_of_segments(p, q);
      if (nearest.distance < best.distance) best = nearest;
    }
  return best;
}

}  // namespace

double separation(const BoxNode& a, const BoxNode& b, const RigidMap& map_of_b) {
  return largest_gap(Pair(a, b, map_of_b));
}

NearestPoints nearest_points(const BoxNode& a, const BoxNode& b, const RigidMap& map_of_b) {
  const Pair pair(a, b, map_of_b);
  const double close = 1e-11 + 0x1p-46 * pair.size();
  constexpr int kMostSteps = 24;
  Simplex simplex;
  Vector3d v = pair.shift;
  NearestPoints result;
  bool found = false;
  for (int step = 0; step < kMostSteps && !found; ++step) {
    const Vertex next = pair.farthest_against(v);
    const double length = v.norm();
    if (simplex.count > 0) {
      if (length <= close || length - v.dot(next.difference) / length <= close) {
        result.distance = length <= close ? 0 : length;
        found = true;
        break;
      }
      bool known = false;
      for (int i = 0; i < simplex.count; ++i)
        known = known || simplex.vertices[static_cast<std::size_t>(i)].difference == next.difference;
      if (known) break;
    }
    simplex.vertices[static_cast<std::size_t>(simplex.count++)] = next;
    simplex = nearest_on(simplex);
    v = simplex.point();
    if (simplex.count == 4) {
      v.setZero();
      found = true;
    }
  }
  if (found) {
    result.on_a = simplex.on_a();
    result.on_b = result.on_a + v;
  } else if (largest_gap(pair) > 0) {
    result = nearest_features(pair);
  } else {
    result.on_a = result.on_b = simplex.on_a();
  }
  const Vector3d centre = centre_of(a);
  result.on_a += centre;
  result.on_b += centre;
  return result;
}

}  // namespace blackleaf::detail
