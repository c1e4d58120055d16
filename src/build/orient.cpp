#include "orient.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "caps.h"

namespace blackleaf::detail {
namespace {

void turn(Triangle& t) { std::swap(t[1], t[2]); }

// Triangles in sets, each either as the first of its set or the other way round.
class Agreement {
 public:
  explicit Agreement(std::size_t size) : parent_(size), differs_(size, 0), one_sided_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  struct Place {
    std::uint32_t root;
    bool differs;  // from the root
  };
  Place find(std::uint32_t i) {
    // To the root, then back down with the sums.
    path_.clear();
    for (; parent_[i] != i; i = parent_[i]) path_.push_back(i);
    bool differs = false;
    for (std::size_t k = path_.size(); k-- > 0;) {
      differs ^= differs_[path_[k]] != 0;
      differs_[path_[k]] = differs;
      parent_[path_[k]] = i;
    }
    return {i, differs};
  }
  // False, and nothing done, if a and b are in one set already and it says otherwise.
  bool relate(std::uint32_t a, std::uint32_t b, bool differ) {
    const Place p = find(a), q = find(b);
    const bool between = p.differs != (q.differs != differ);
    if (p.root == q.root) return !between;
    const std::uint32_t low = std::min(p.root, q.root), high = std::max(p.root, q.root);
    parent_[high] = low;
    differs_[high] = between;
    one_sided_[low] |= one_sided_[high];
    return true;
  }
  void set_one_sided(std::uint32_t i) { one_sided_[find(i).root] = 1; }
  bool one_sided(std::uint32_t root) const { return one_sided_[root] != 0; }

 private:
  std::vector<std::uint32_t> parent_, path_;
  std::vector<std::uint8_t> differs_, one_sided_;
};

// Exact sum of numbers below 2^124 in size.
class WideSum {
 public:
  void add(Wide value) {
    low_ += static_cast<std::uint64_t>(value);
    high_ += value >> 64;
    high_ += low_ >> 64;
    low_ &= ~std::uint64_t{0};
  }
  void add(const WideSum& other) {
    high_ += other.high_;
    add(other.low_);
  }
  void negate() {
    const Wide low = low_;
    high_ = -high_;
    low_ = 0;
    add(-low);
  }
  int sign() const { return high_ < 0 ? -1 : high_ > 0 || low_ > 0 ? 1 : 0; }
  WideSum size() const {
    WideSum result = *this;
    if (sign() < 0) result.negate();
    return result;
  }
  friend bool operator<(const WideSum& a, const WideSum& b) {
    return a.high_ != b.high_ ? a.high_ < b.high_ : a.low_ < b.low_;
  }

 private:
  Wide high_ = 0, low_ = 0;  // the sum is 2^64 high + low, 0 <= low < 2^64
};

struct Part {
  std::vector<std::uint32_t> triangles;
  std::vector<Triangle> caps;
  WideSum volume;            // six times that of the capped part, as it faces now
  double area = 0, cap = 0;  // twice those of its triangles and of its caps
  bool mended = false;       // some of its triangles were turned
  bool one_sided = false;

  // Whether it says which side is its inside: a sheet that is mostly hole does not.
  bool has_inside() const { return !one_sided && volume.sign() != 0 && 2 * cap < area; }
  GridPoint low, high;
};

// The parts, in order of their first triangles; turns triangles so that those of a part agree.
std::vector<Part> parts_of(GridMesh& mesh) {
  Agreement agreement(mesh.triangles.size());
  std::vector<std::vector<std::uint32_t>> balanced;
  for_each_edge(mesh.triangles, mesh.vertices.size(), [&](std::uint32_t, std::span<const EdgeUse> uses) {
    if (uses.size() == 2) {
      if (!agreement.relate(uses[0].triangle, uses[1].triangle, uses[0].direction == uses[1].direction))
        agreement.set_one_sided(uses[0].triangle);
      return;
    }
    std::int64_t balance = 0;
    for (const EdgeUse& use : uses) balance += use.direction;
    if (balance != 0) return;
    balanced.emplace_back();
    for (const EdgeUse& use : uses) balanced.back().push_back(use.triangle);
  });
  for (const auto& edge : balanced)
    for (std::size_t i = 1; i < edge.size(); ++i) agreement.relate(edge[0], edge[i], false);

  std::vector<Part> parts;
  std::vector<std::uint32_t> part_of(mesh.triangles.size());
  std::vector<std::size_t> turned;  // by part: triangles that differ from the root
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Agreement::Place place = agreement.find(i);  // the root is the first triangle of its set
    if (place.root == i) {
      part_of[i] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
      parts.back().one_sided = agreement.one_sided(i);
      turned.push_back(0);
    }
    const std::uint32_t part = part_of[i] = part_of[place.root];
    parts[part].triangles.push_back(i);
    turned[part] += place.differs;
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Part& part = parts[k];
    if (part.one_sided || turned[k] == 0) continue;
    part.mended = true;
    const bool fewer_differ = 2 * turned[k] <= part.triangles.size();
    for (const std::uint32_t i : part.triangles)
      if (agreement.find(i).differs == fewer_differ) turn(mesh.triangles[i]);
  }
  return parts;
}

// Six times the volume between the triangle and a point, positive if the triangle faces away from it.
Wide cone(const std::vector<GridPoint>& vertices, const Triangle& t, const GridPoint& apex) {
  const GridPoint &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
  Wide six = 0;
  for (std::size_t i = 0; i < 3; ++i) six += normal(a, b, c, i) * (a[i] - apex[i]);
  return six;
}

double twice_area(const std::vector<GridPoint>& vertices, const Triangle& t) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double n = static_cast<double>(normal(vertices[t[0]], vertices[t[1]], vertices[t[2]], i));
    square += n * n;
  }
  return std::sqrt(square);
}

void measure(Part& part, const GridMesh& mesh) {
  const std::vector<GridPoint>& vertices = mesh.vertices;
  const GridPoint& origin = vertices[mesh.triangles[part.triangles.front()][0]];
  part.low = part.high = origin;
  for (const std::uint32_t i : part.triangles) {
    part.volume.add(cone(vertices, mesh.triangles[i], origin));
    part.area += twice_area(vertices, mesh.triangles[i]);
    for (const std::uint32_t v : mesh.triangles[i])
      for (std::size_t axis = 0; axis < 3; ++axis) {
        part.low[axis] = std::min(part.low[axis], vertices[v][axis]);
        part.high[axis] = std::max(part.high[axis], vertices[v][axis]);
      }
  }
  for (const Triangle& t : part.caps) {
    part.volume.add(cone(vertices, t, origin));
    part.cap += twice_area(vertices, t);
  }
}

// Whether the triangles, but for those of mended and one-sided parts, face the centre of their box rather than away
// from it.
bool faces_inward(const std::vector<Part>& parts, const GridMesh& mesh) {
  GridPoint low = parts.front().low, high = parts.front().high, centre{};
  for (const Part& part : parts)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], part.low[axis]);
      high[axis] = std::max(high[axis], part.high[axis]);
      centre[axis] = (low[axis] + high[axis]) / 2;
    }
  WideSum sum;
  for (const Part& part : parts)
    if (!part.mended && !part.one_sided)
      for (const std::uint32_t i : part.triangles) sum.add(cone(mesh.vertices, mesh.triangles[i], centre));
  return sum.sign() < 0;
}

void turn_over(Part& part, GridMesh& mesh) {
  for (const std::uint32_t i : part.triangles) turn(mesh.triangles[i]);
  for (Triangle& t : part.caps) turn(t);
  part.volume.negate();
}

// Finds around which points, the centroids of triangles of doubtful parts, larger parts wind.
class Nesting {
 public:
  Nesting(const GridMesh& mesh, const std::vector<Part>& parts, const std::vector<std::uint32_t>& rank)
      : mesh_(mesh), vertices_(mesh.vertices), parts_(parts), rank_(rank) {}

  void add_points(std::uint32_t part) {
    for (const std::uint32_t i : parts_[part].triangles) {
      Point point{{}, part};
      for (const std::uint32_t v : mesh_.triangles[i])
        for (std::size_t axis = 0; axis < 3; ++axis) point.at[axis] += vertices_[v][axis];
      points_.push_back(point);
    }
  }
  void find() {
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.at[2] < b.at[2]; });
    hits_.resize(parts_.size());
    for (std::uint32_t part = 0; part < parts_.size(); ++part) {
      for (const std::uint32_t i : parts_[part].triangles) meet(part, mesh_.triangles[i]);
      for (const Triangle& t : parts_[part].caps) meet(part, t);
    }
  }
  // Whether the larger parts, each turned over if `turned` says so, wind about all centroids of a part.
  bool nested(std::uint32_t part, const std::vector<std::uint8_t>& turned) const {
    std::vector<std::pair<std::uint32_t, std::int32_t>> windings;  // by point
    for (const Hit& hit : hits_[part]) windings.emplace_back(hit.point, turned[hit.part] ? -hit.change : hit.change);
    std::sort(windings.begin(), windings.end());
    std::size_t inside = 0;
    for (std::size_t i = 0; i < windings.size();) {
      const std::uint32_t point = windings[i].first;
      std::int64_t winding = 0;
      for (; i < windings.size() && windings[i].first == point; ++i) winding += windings[i].second;
      inside += winding > 0;
    }
    return inside == parts_[part].triangles.size();
  }

 private:
  struct Point {
    GridPoint at;  // three times the centroid
    std::uint32_t part;
  };
  struct Hit {
    std::uint32_t point, part;
    std::int32_t change;
  };

  void meet(std::uint32_t part, const Triangle& t) {
    const GridPoint &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
    const std::int64_t low_y = 3 * std::min({a[1], b[1], c[1]}), high_y = 3 * std::max({a[1], b[1], c[1]});
    const std::int64_t low_z = 3 * std::min({a[2], b[2], c[2]}), high_z = 3 * std::max({a[2], b[2], c[2]});
    auto point = std::lower_bound(points_.begin(), points_.end(), low_z,
                                  [](const Point& p, std::int64_t z) { return p.at[2] < z; });
    for (; point != points_.end() && point->at[2] <= high_z; ++point) {
      if (point->at[1] < low_y || point->at[1] > high_y || rank_[part] >= rank_[point->part]) continue;
      const int change = crossing(point->at, a, b, c);
      if (change != 0)
        hits_[point->part].push_back({static_cast<std::uint32_t>(point - points_.begin()), part, change});
    }
  }

  // What a triangle adds to the winding number of a point, given three times over and moved by (e, e^2, e^3): 1 or -1
  // if the ray from it along x leaves or enters. Bounds: differences are below 3 (2^40 + 1), so heights, three products
  // with components of a normal, below 2^125.
  static int crossing(const GridPoint& p, const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    const auto first = [](std::initializer_list<Wide> coefficients) {
      for (const Wide k : coefficients)
        if (k != 0) return k > 0 ? 1 : -1;
      return 0;
    };
    const auto side = [&](const GridPoint& u, const GridPoint& v) {
      const Wide dy = v[1] - u[1], dz = v[2] - u[2];
      return first({dy * (p[2] - 3 * u[2]) - dz * (p[1] - 3 * u[1]), -dz, dy});
    };
    const int s = side(a, b);
    if (s == 0 || side(b, c) != s || side(c, a) != s) return 0;
    const std::array<Wide, 3> n = {normal(a, b, c, 0), normal(a, b, c, 1), normal(a, b, c, 2)};
    const Wide height = n[0] * (p[0] - 3 * a[0]) + n[1] * (p[1] - 3 * a[1]) + n[2] * (p[2] - 3 * a[2]);
    return first({height, n[0], n[1], n[2]}) != s ? s : 0;  // the normal's x has the sign s: p lies before the triangle
  }

  const GridMesh& mesh_;
  const std::vector<GridPoint>& vertices_;
  const std::vector<Part>& parts_;
  const std::vector<std::uint32_t>& rank_;
  std::vector<Point> points_;
  std::vector<std::vector<Hit>> hits_;  // by part
};

bool within(const Part& inner, const Part& outer) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (inner.low[axis] < outer.low[axis] || inner.high[axis] > outer.high[axis]) return false;
  return true;
}

void face_outward(std::vector<Part>& parts, GridMesh& mesh) {
  // Larger ones first.
  std::vector<std::uint32_t> order(parts.size()), rank(parts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return parts[b].volume.size() < parts[a].volume.size(); });
  for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;

  const auto doubtful = [&](const Part& part) { return part.has_inside() && (part.mended || part.volume.sign() < 0); };
  Nesting nesting(mesh, parts, rank);
  bool any = false;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Part& part = parts[order[i]];
    const auto may_hold = [&](std::uint32_t other) { return within(part, parts[other]); };
    if (!doubtful(part) || std::none_of(order.begin(), order.begin() + i, may_hold)) continue;
    nesting.add_points(order[i]);
    any = true;
  }
  if (any) nesting.find();
  std::vector<std::uint8_t> turned(parts.size(), 0);
  for (const std::uint32_t i : order) {
    if (!doubtful(parts[i])) continue;
    const bool inward = any && nesting.nested(i, turned);
    turned[i] = (parts[i].volume.sign() < 0) != inward;
  }
  for (std::uint32_t i = 0; i < parts.size(); ++i)
    if (turned[i]) turn_over(parts[i], mesh);
}

}  // namespace

Orientation orient(GridMesh& mesh) {
  Orientation result;
  if (mesh.triangles.empty()) return result;
  const std::vector<Triangle> given = mesh.triangles;
  std::vector<Part> parts = parts_of(mesh);

  std::vector<std::uint32_t> part_of(mesh.triangles.size());
  for (std::uint32_t k = 0; k < parts.size(); ++k)
    for (const std::uint32_t i : parts[k].triangles) part_of[i] = k;
  const auto holes = boundaries(mesh.triangles, mesh.vertices.size(), part_of, parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].caps = caps_of(holes[k]).triangles;

  for (Part& part : parts) measure(part, mesh);
  const bool inside_out = faces_inward(parts, mesh);
  if (inside_out)
    for (Part& part : parts) turn_over(part, mesh);
  face_outward(parts, mesh);

  for (std::size_t i = 0; i < given.size(); ++i) result.turned += (mesh.triangles[i] != given[i]) != inside_out;
  for (const Part& part : parts) result.one_sided += part.one_sided;
  return result;
}

}  // namespace blackleaf::detail
