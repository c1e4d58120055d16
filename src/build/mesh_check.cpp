// Checking meshes as boundaries of solids.
#include <bit>
#include <cmath>

#include "blackleaf/mesh.h"
#include "surface.h"

namespace blackleaf {
namespace {

// Sums and products of doubles without error, as sums of doubles of decreasing size (Dekker, Knuth, Shewchuk).
// Exact as long as nothing overflows or falls below the smallest normal number.
class ExactSum {
 public:
  void add(double value) {
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = value + parts_[i];
      const double back = sum - value;
      parts_[i] = (value - (sum - back)) + (parts_[i] - back);
      value = sum;
    }
    parts_[count_++] = value;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  // The parts do not overlap, so the sum is zero only if each of them is.
  bool is_zero() const {
    for (std::size_t i = 0; i < count_; ++i)
      if (parts_[i] != 0) return false;
    return true;
  }

 private:
  std::array<double, 12> parts_{};
  std::size_t count_ = 0;
};

// Whether three points of a plane lie on a line: (b - a) x (c - a) = a x b + b x c + c x a = 0.
bool on_a_line(double ax, double ay, double bx, double by, double cx, double cy) {
  const double left = (bx - ax) * (cy - ay), right = (by - ay) * (cx - ax);
  // The rounding error of left - right is below 2^-50 times this size (three roundings a side, one of the difference).
  if (std::abs(left - right) > 0x1p-50 * (std::abs(left) + std::abs(right))) return false;
  ExactSum sum;
  sum.add_product(ax, by);
  sum.add_product(-ay, bx);
  sum.add_product(bx, cy);
  sum.add_product(-by, cx);
  sum.add_product(cx, ay);
  sum.add_product(-cy, ax);
  return sum.is_zero();
}

bool without_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return on_a_line(a.x(), a.y(), b.x(), b.y(), c.x(), c.y()) && on_a_line(a.y(), a.z(), b.y(), b.z(), c.y(), c.z()) &&
         on_a_line(a.z(), a.x(), b.z(), b.x(), c.z(), c.x());
}

}  // namespace

Eigen::AlignedBox3d TriangleMesh::bounding_box() const {
  Eigen::AlignedBox3d box;
  for (const detail::Triangle& triangle : triangles)
    for (const std::uint32_t corner : triangle) box.extend(vertices[corner]);
  return box;
}

MeshReport check(const TriangleMesh& mesh) {
  detail::require_sound(mesh);
  std::vector<std::array<std::uint64_t, 3>> keys(mesh.vertices.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)  // adding +0 makes -0 equal to it
      keys[i][static_cast<std::size_t>(axis)] = std::bit_cast<std::uint64_t>(mesh.vertices[i][axis] + 0.0);
  const std::vector<std::uint32_t> first = detail::first_equal(keys);

  std::uint64_t degenerate = 0;
  std::vector<detail::Triangle> welded;
  welded.reserve(mesh.triangles.size());
  for (const detail::Triangle& triangle : mesh.triangles) {
    const detail::Triangle t = {first[triangle[0]], first[triangle[1]], first[triangle[2]]};
    if (detail::collapsed(t)) {
      ++degenerate;
      continue;
    }
    degenerate += without_area(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    welded.push_back(t);
  }
  MeshReport report = detail::report_of(welded, first.size(), true);
  report.triangles = mesh.triangles.size();
  report.degenerate_triangles = degenerate;
  return report;
}

}  // namespace blackleaf
