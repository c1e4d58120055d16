#include "continuous.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace blackleaf::detail {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows

Vector vector(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
Matrix matrix(const Eigen::Matrix3d& m) {
  Matrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return result;
}
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
Vector operator*(const Matrix& m, const Vector& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
// m^T v.
Vector back(const Matrix& m, const Vector& v) {
  return {m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2], m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
          m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2]};
}
Vector widened(const std::array<float, 3>& v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }
double reach(const Vector& half, const Vector& n) {
  return half[0] * std::abs(n[0]) + half[1] * std::abs(n[1]) + half[2] * std::abs(n[2]);
}

// Where both solids are at a time, seen from where a is at the interval's middle: x of a at A x, y of b at B y + shift.
struct Place {
  Matrix a, b;
  Vector shift;
};

// Crossed edges that are parallel to 2^-20 separate nothing that faces do not.
constexpr double kParallel = 0x1p-40;

}  // namespace

struct Continuous::View {
  double begin = 0, middle = 0;
  Place at_begin, at_end;
  Matrix b, sizes;  // b's rotation at the middle, and its entries' sizes
  Vector shift;
  Matrix crossed{};               // 1 / the length of e_i x column j; 0 if they are parallel
  double turn_a = 0, turn_b = 0;  // radians in the interval
  double bend_a = 0, bend_b = 0;  // slack for each voxel of a radius
  bool a_rests = false;
  RigidMap b_from_a_at_begin, b_from_a_at_middle;
};

Continuous::Verdict Continuous::contact(double place, double distance) {
  place_ = place;
  distance_ = distance;
  return Verdict::contact;
}

bool Continuous::lower(double place, double distance) {
  contact(place, distance);
  above_ = distance;
  lowered_ = true;
  return above_ <= settings_.tolerance;
}

bool Continuous::search(const Stretch& stretch) {
  stretch_ = &stretch;
  pairs_.assign(1, {a_.root(), b_.root()});
  lowered_ = false;
  const bool found = interval(0, 1, at(0), at(1), 0, 0);
  return least() ? lowered_ : found;
}

bool Continuous::interval(double begin, double end, const Moment& at_begin, const Moment& at_end, std::size_t first,
                          int depth) {
  const std::size_t last = pairs_.size();
  const double middle = begin + (end - begin) / 2;
  const Moment at_middle = at(middle);

  View view;
  view.begin = begin;
  view.middle = middle;
  const auto seen = [&](const Moment& moment) {
    const Eigen::Matrix3d from = at_middle.a.rotation.transpose();
    return Place{matrix(from * moment.a.rotation), matrix(from * moment.b.rotation),
                 vector(from * (moment.b.shift - moment.a.shift))};
  };
  view.at_begin = seen(at_begin);
  view.at_end = seen(at_end);
  const auto from_a = [](const Moment& moment) {
    const Eigen::Matrix3d from = moment.a.rotation.transpose();
    return RigidMap{from * moment.b.rotation, from * (moment.b.shift - moment.a.shift)};
  };
  view.b_from_a_at_begin = from_a(at_begin);
  view.b_from_a_at_middle = from_a(at_middle);
  view.b = matrix(view.b_from_a_at_middle.rotation);
  view.shift = vector(view.b_from_a_at_middle.shift);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      view.sizes[i][j] = std::abs(view.b[i][j]);
      const double p = view.b[(i + 1) % 3][j], q = view.b[(i + 2) % 3][j], squared = p * p + q * q;
      view.crossed[i][j] = squared > kParallel ? 1 / std::sqrt(squared) : 0;
    }
  view.a_rests = stretch_->a.rests();
  view.turn_a = stretch_->a.angle * (end - begin);
  view.turn_b = stretch_->b.angle * (end - begin);
  view.bend_a = view.turn_a * view.turn_a / 8;
  view.bend_b = view.turn_b * view.turn_b / 8;

  bool found = false;
  for (std::size_t i = first; i < last && !found; ++i) {
    stack_.assign(1, pairs_[i]);
    while (!stack_.empty() && !found) {
      const Pair pair = stack_.back();
      stack_.pop_back();
      switch (judge(pair, view)) {
        case Verdict::apart:
          break;
        case Verdict::contact:
          found = true;
          break;
        case Verdict::wait:
          pairs_.push_back(pair);
          break;
        case Verdict::split_a: {
          const BoxNode& node = a_.nodes[pair.a];
          for (std::uint32_t k = 0; k < node.count(); ++k) stack_.push_back({node.first() + k, pair.b});
          break;
        }
        case Verdict::split_b: {
          const BoxNode& node = b_.nodes[pair.b];
          for (std::uint32_t k = 0; k < node.count(); ++k) stack_.push_back({pair.a, node.first() + k});
          break;
        }
      }
    }
  }
  if (!found && pairs_.size() > last) {
    found = interval(begin, middle, at_begin, at_middle, last, depth + 1) ||
            interval(middle, end, at_middle, at_end, last, depth + 1);
    if (settings_.done && depth == kPartBits) settings_.done(1);
  } else if (settings_.done && depth <= kPartBits) {
    settings_.done(kParts >> depth);
  }
  pairs_.resize(last);
  return found;
}

Continuous::Verdict Continuous::judge(const Pair& pair, const View& view) {
  const BoxNode &node_a = a_.nodes[pair.a], &node_b = b_.nodes[pair.b];
  const Vector centre_a = widened(node_a.centre), centre_b = widened(node_b.centre);
  const double ball_a = double{node_a.radius}, ball_b = double{node_b.radius};
  const auto between = [&](const Place& place) {
    const Vector from = view.a_rests ? centre_a : place.a * centre_a;
    return place.b * centre_b + place.shift - from;
  };
  const Vector d0 = between(view.at_begin), d1 = between(view.at_end), chord = d1 - d0;
  const double limit = clearance() + slop_;

  // Balls.
  const double radius_a = view.turn_a > 0 ? stretch_->a.radius(centre_of(node_a)) : 0,
               radius_b = view.turn_b > 0 ? stretch_->b.radius(centre_of(node_b)) : 0;
  const double squared = dot(chord, chord), along = -dot(d0, chord);
  const double t = along <= 0 ? 0 : along >= squared ? 1 : along / squared;
  const Vector nearest = d0 + t * chord;
  const double balls = ball_a + ball_b + view.bend_a * radius_a + view.bend_b * radius_b + limit;
  if (balls < 0 || dot(nearest, nearest) > balls * balls) return Verdict::apart;

  // Axes.
  const Vector half_a = widened(node_a.half), half_b = widened(node_b.half);
  const double slack = view.bend_a * (radius_a + ball_a) + view.bend_b * (radius_b + ball_b);
  const double need = limit + slack;
  const auto gap = [&](const Place& place, const Vector& d, const Vector& n) {
    const double of_a = reach(half_a, view.a_rests ? n : back(place.a, n));
    return dot(n, d) - of_a - reach(half_b, back(place.b, n));
  };
  const Vector d = view.b * centre_b + view.shift - centre_a;
  const auto proven = [&](Vector n) {
    if (dot(n, d) < 0) n = -1.0 * n;
    return gap(view.at_begin, d0, n) > need && gap(view.at_end, d1, n) > need;
  };
  double largest = -1e300;
  // The chord's part across an axis moves the gap by half of itself from the middle to the ends, if evenly.
  const auto promising = [&](double at_middle, double across) {
    largest = std::max(largest, at_middle);
    return at_middle - std::abs(across) / 2 > need;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!promising(std::abs(d[i]) - half_a[i] - dot(view.sizes[i], half_b), chord[i])) continue;
    Vector n{};
    n[i] = 1;
    if (proven(n)) return Verdict::apart;
  }
  const Vector d_b = back(view.b, d), chord_b = back(view.b, chord), half_a_b = back(view.sizes, half_a);
  for (std::size_t j = 0; j < 3; ++j)
    if (promising(std::abs(d_b[j]) - half_b[j] - half_a_b[j], chord_b[j]) &&
        proven({view.b[0][j], view.b[1][j], view.b[2][j]}))
      return Verdict::apart;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t p = (i + 1) % 3, q = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      if (view.crossed[i][j] == 0) continue;
      const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
      // e_i x column j has the coordinates -b_qj at p and b_pj at q.
      const double scale = view.crossed[i][j], bp = view.b[p][j], bq = view.b[q][j];
      const double reaches = half_a[p] * view.sizes[q][j] + half_a[q] * view.sizes[p][j] +
                             half_b[k] * view.sizes[i][l] + half_b[l] * view.sizes[i][k];
      if (!promising((std::abs(d[q] * bp - d[p] * bq) - reaches) * scale, (chord[q] * bp - chord[p] * bq) * scale))
        continue;
      Vector n{};
      n[p] = -bq * scale;
      n[q] = bp * scale;
      if (proven(n)) return Verdict::apart;
    }
  }

  // Planes: along the normal of one of the nodes.
  if (node_a.has_plane() || node_b.has_plane()) {
    const Vector normal_a = widened(node_a.normal), normal_b = widened(node_b.normal);
    const auto reach_with_plane = [](const Vector& half, const Vector& n, const Vector& normal, double most) {
      const double box = reach(half, n);
      return normal[0] == 0 && normal[1] == 0 && normal[2] == 0 ? box : std::min(box, most + reach(half, n - normal));
    };
    // Seen from the nodes' own frames: the reach of a along n and of b against it.
    const auto plane_gap = [&](const Place& place, const Vector& from_a_to_b, const Vector& n) {
      const Vector of_a = view.a_rests ? n : back(place.a, n), of_b = -1.0 * back(place.b, n);
      return dot(n, from_a_to_b) - reach_with_plane(half_a, of_a, normal_a, double{node_a.reach}) -
             reach_with_plane(half_b, of_b, normal_b, double{node_b.reach});
    };
    // Normals are of length 1 up to 2^-22.
    const double enough = need + (std::abs(need) + ball_a + ball_b) * 0x1p-20;
    for (const bool of_a : {true, false}) {
      if (!(of_a ? node_a : node_b).has_plane()) continue;
      const Vector n = of_a ? normal_a : -1.0 * (view.b * normal_b);
      if (plane_gap(view.at_begin, d0, n) > enough && plane_gap(view.at_end, d1, n) > enough) return Verdict::apart;
    }
  }

  const double way = std::sqrt(squared) + view.turn_a * ball_a + view.turn_b * ball_b + slack;
  if (node_a.is_leaf() && node_b.is_leaf()) {
    if (way <= settings_.tolerance - 8 * slop_) return judge_at_begin(pair, view);
    if (settings_.question == Question::any) {
      // Not clear is known as soon as any time shows it. Axes that are left out, crossed edges nearly parallel, could
      // part the boxes by this more.
      const double left_out = 0x1p-19 * (ball_a + ball_b);
      if (largest < std::min(0.0, clearance()) - slop_ - left_out) return contact(view.middle, largest);
    }
    if (clearance() <= 0 && !least()) return Verdict::wait;
    // With a clearance the shortest connection tells more than the axes.
    const NearestPoints points = nearest_points(node_a, node_b, view.b_from_a_at_middle);
    if (least() && points.distance < above_ && lower(view.middle, points.distance)) return Verdict::contact;
    if (points.distance == 0) return Verdict::wait;
    return proven((1 / points.distance) * vector(points.on_b - points.on_a)) ? Verdict::apart : Verdict::wait;
  }
  const bool split_a = node_b.is_leaf() || (!node_a.is_leaf() && ball_a >= ball_b);
  if (2 * (split_a ? ball_a : ball_b) < way) return Verdict::wait;
  return split_a ? Verdict::split_a : Verdict::split_b;
}

// Within the interval the leaves come at most the tolerance nearer than they are at its beginning.
Continuous::Verdict Continuous::judge_at_begin(const Pair& pair, const View& view) {
  const BoxNode &node_a = a_.nodes[pair.a], &node_b = b_.nodes[pair.b];
  double distance = nearest_points(node_a, node_b, view.b_from_a_at_begin).distance;
  if (least()) return distance < above_ && lower(view.begin, distance) ? Verdict::contact : Verdict::apart;
  if (distance <= slop_) distance = std::min(0.0, separation(node_a, node_b, view.b_from_a_at_begin));
  if (distance > clearance() + settings_.tolerance - 2 * slop_) return Verdict::apart;
  return contact(view.begin, distance);
}

}  // namespace blackleaf::detail
