#include "rim_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace blackleaf::detail {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Taken off distances: more than the roundings of places of up to 2^20 voxels.
constexpr double kSlack = 0x1p-24;

Place difference(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const Place& a, const Place& b) {
  const Place d = difference(a, b);
  return std::sqrt(dot(d, d));
}

double distance_to_edge(const Place& p, const Place& a, const Place& b) {
  const Place ab = difference(b, a), ap = difference(p, a);
  const double square = dot(ab, ab);
  const double t = square > 0 ? std::clamp(dot(ap, ab) / square, 0.0, 1.0) : 0.0;
  return distance(p, {a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]});
}

}  // namespace

class RimField::Builder {
 public:
  Builder(RimField& field, const GridMesh& mesh, const Caps& caps) : field_(field), mesh_(mesh), caps_(caps) {
    for (std::uint32_t loop = 0; loop < caps.loops(); ++loop) {
      order_.push_back(loop);
      Place sum{};
      for (std::size_t i = begin_of(loop); i < caps.ends[loop]; ++i) {
        const Place p = place(caps.rims[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += p[axis];
      }
      const auto size = static_cast<double>(caps.ends[loop] - begin_of(loop));
      for (double& s : sum) s /= size;
      means_.push_back(sum);
    }
    if (!order_.empty()) loops(order_);
  }

 private:
  std::size_t begin_of(std::uint32_t loop) const { return loop == 0 ? 0 : caps_.ends[loop - 1]; }
  Place place(std::uint32_t vertex) const {
    Place result{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      result[axis] = std::ldexp(static_cast<double>(mesh_.vertices[vertex][axis]), -mesh_.fraction_bits());
    return result;
  }

  double area_of(std::uint32_t loop) const {
    // A loop of n vertices has n - 2 triangles.
    double area = 0;
    for (std::size_t i = begin_of(loop) - 2 * loop; i < caps_.ends[loop] - 2 * (loop + 1); ++i) {
      const Triangle& t = caps_.triangles[i];
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Wide n = normal(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], axis);
        const double component = std::ldexp(static_cast<double>(n), -2 * mesh_.fraction_bits() - 1);
        square += component * component;
      }
      area += std::sqrt(square);
    }
    return area * (1 + 0x1p-30);
  }

  // The ball of some loops, halved where their means spread most.
  std::uint32_t loops(std::span<std::uint32_t> order) {
    if (order.size() == 1) {
      const std::uint32_t loop = order.front();
      const std::size_t first = field_.edges_.size(), begin = begin_of(loop), end = caps_.ends[loop];
      for (std::size_t i = begin; i < end; ++i)
        field_.edges_.push_back({place(caps_.rims[i]), place(caps_.rims[i + 1 < end ? i + 1 : begin])});
      const std::uint32_t ball = piece(first, field_.edges_.size());
      field_.balls_[ball].area = area_of(loop);
      return ball;
    }
    Place low = means_[order.front()], high = low;
    for (const std::uint32_t loop : order)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], means_[loop][axis]);
        high[axis] = std::max(high[axis], means_[loop][axis]);
      }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
      if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double u = means_[a][longest], v = means_[b][longest];
                       return u != v ? u < v : a < b;
                     });
    const std::uint32_t ball = add();
    const std::size_t first = field_.edges_.size();
    const std::uint32_t one = loops(order.first(half)), other = loops(order.subspan(half));
    finish(ball, first, field_.edges_.size(), other);
    field_.balls_[ball].area = field_.balls_[one].area + field_.balls_[other].area;
    return ball;
  }

  // The ball of the edges [first, last) of a loop.
  std::uint32_t piece(std::size_t first, std::size_t last) {
    const std::uint32_t ball = add();
    std::uint32_t second = 0;
    if (last - first > 1) {
      const std::size_t middle = first + (last - first) / 2;
      piece(first, middle);
      second = piece(middle, last);
    }
    finish(ball, first, last, second);
    return ball;
  }

  std::uint32_t add() {
    field_.balls_.emplace_back();
    return static_cast<std::uint32_t>(field_.balls_.size() - 1);
  }

  void finish(std::uint32_t index, std::size_t first, std::size_t last, std::uint32_t second) {
    Ball& ball = field_.balls_[index];
    ball.edge = static_cast<std::uint32_t>(first);
    ball.second = second;
    ball.area = kInfinity;
    const std::span<const Edge> edges(field_.edges_.data() + first, last - first);
    for (const Edge& edge : edges) {
      ball.length += distance(edge.a, edge.b);
      for (std::size_t axis = 0; axis < 3; ++axis) ball.centre[axis] += edge.a[axis] + edge.b[axis];
    }
    for (double& c : ball.centre) c /= 2 * static_cast<double>(edges.size());
    for (const Edge& edge : edges)
      ball.radius = std::max({ball.radius, distance(edge.a, ball.centre), distance(edge.b, ball.centre)});
  }

  RimField& field_;
  const GridMesh& mesh_;
  const Caps& caps_;
  std::vector<std::uint32_t> order_;  // loops
  std::vector<Place> means_;          // of the vertices of each loop
};

RimField::RimField(const GridMesh& mesh, const Caps& caps) { Builder(*this, mesh, caps); }

double RimField::slope(const Place& p, double h, double limit) const {
  if (balls_.empty()) return 0;
  limit *= 4 * kPi;
  double sum = 0;
  std::array<std::uint32_t, 96> stack;  // halving leaves one at each level: at most 32 of loops and 32 of pieces
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Ball& ball = balls_[index];
    double gap = distance(p, ball.centre) - ball.radius - h - kSlack;
    double bound = kInfinity;
    if (gap > 2 * ball.radius) {
      bound = std::min(ball.length, 2 * ball.area / gap) / (gap * gap);
    } else if (ball.second != 0) {
      stack[size++] = ball.second;
      stack[size++] = index + 1;
      continue;
    } else {
      const Edge& edge = edges_[ball.edge];
      gap = distance_to_edge(p, edge.a, edge.b) - h - kSlack;
      if (gap > 0) bound = std::min(ball.length / (gap * gap), 2 / gap);
    }
    sum += bound;
    if (!(sum <= limit)) return kInfinity;
  }
  return sum / (4 * kPi) * (1 + 0x1p-30);
}

}  // namespace blackleaf::detail
