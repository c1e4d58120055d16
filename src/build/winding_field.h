// The winding number of a set of triangles as a function of the place, bounded over boxes and decided at points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid_mesh.h"
#include "octree/brick.h"
#include "solid_angle.h"

namespace blackleaf::detail {

/// A range of integers, ends included.
struct Levels {
  int low, high;
};

/// The triangles in a hierarchy of balls (Barill et al. 2018). With K(x) = x / |x|^3, a ball of triangles about c, seen
/// from p, adds the integral of n.K(x - p) over 4 pi, nearly V.K(c - p) + M:K'(c - p): V is the integral of the normals
/// n, M that of n (x - c)^T. What is left out is at most A R^2 max|K''| / 2 over 4 pi, A the area, R the radius, and
/// |K''| <= 6 / |x|^4. If p is only known to within h, V moves by at most 2 |V| h / |x|^3 and R becomes R + h.
class WindingField {
 public:
  WindingField(const GridMesh& mesh, const std::vector<Triangle>& triangles);

  /// The least integer greater than w(p) + 1/2 at a voxel's centre.
  int level(std::int32_t x, std::int32_t y, std::int32_t z) const;
  /// Bounds of level() at all voxel centres of a cube; `all` if nothing narrower is found.
  Levels levels(const Cube& cube, const Levels& all) const;

 private:
  struct Ball {
    std::array<double, 3> centre{}, vector{};       // voxels, square voxels: c and V
    std::array<std::array<double, 3>, 3> moment{};  // cubic voxels: M
    double radius = 0, area = 0, length = 0;        // R, A, |V|
    std::uint32_t begin = 0, end = 0;               // its triangles
    std::uint32_t second = 0;                       // its children are the next ball and this one; 0: none
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
                      const std::vector<std::array<double, 3>>& centroids);
  Ball ball_of(std::uint32_t begin, std::uint32_t end) const;
  // What a ball adds at places within h of a point.
  Turns far(const Ball& ball, const std::array<double, 3>& p, double h) const;
  Turns sum(const GridPoint& p, double tolerance) const;

  const int depth_;
  const int fraction_bits_;
  std::vector<GridTriangle> triangles_;  // those of a ball stand together
  std::vector<Ball> balls_;              // parents first, each followed by its first child
  double area_ = 0;
};

}  // namespace blackleaf::detail
