// The winding number of a set of triangles as a function of the place, summed as precisely as needed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid_mesh.h"
#include "solid_angle.h"

namespace blackleaf::detail {

/// Bounds of the rounding of places, radii and dipoles and of the arcus tangent, whichever library computes it; the
/// true sizes are below 2^-40.
constexpr double kFieldRounding = 0x1p-30;

/// A range of integers, ends included.
struct Levels {
  int low, high;
};
/// The range of the least integer greater than w + 1/2, where w may change by `change` either way. Requires: both
/// errors are below 2^30.
Levels levels_of(const Turns& w, double change);

/// The triangles in a hierarchy of balls (Barill et al. 2018). With K(x) = x / |x|^3, a ball of triangles about c, seen
/// from p, adds the integral of n.K(x - p) over 4 pi, nearly V.K(c - p) + M:K'(c - p): V is the integral of the normals
/// n, M that of n (x - c)^T. What is left out is at most A R^2 max|K''| / 2 over 4 pi, A the area, R the radius, and
/// |K''| <= 6 / |x|^4. Following the gradient -K'(c - p) V from p for up to h leaves out the same with R + h for R.
class WindingField {
 public:
  WindingField(const GridMesh& mesh, const std::vector<Triangle>& triangles);

  /// w(p); far balls are taken as a whole where their errors together are about `tolerance` or less; with 0 none are.
  Turns sum(const GridPoint& p, double tolerance) const;
  /// The least integer greater than w(p) + 1/2.
  int level(const GridPoint& p) const;

  /// The field near a place: all but the nearest triangles as one linear function.
  struct Around {
    std::array<double, 3> centre{}, gradient{};  // voxels
    Turns at_centre;                             // its error is that of all places within reach
    std::vector<GridTriangle> near;
  };
  /// What is around places within h voxels of p; the error of the linear function is about `tolerance` or less.
  Around around(const GridPoint& p, double h, double tolerance) const;
  /// w(p) for p within reach of the place.
  Turns sum(const Around& around, const GridPoint& p) const;

 private:
  struct Ball {
    std::array<double, 3> centre{}, vector{};       // voxels, square voxels: c and V
    std::array<std::array<double, 3>, 3> moment{};  // cubic voxels: M
    double radius = 0, area = 0;                    // R, A
    std::uint32_t begin = 0, end = 0;               // its triangles
    std::uint32_t second = 0;                       // its children are the next ball and this one; 0: none
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
                      const std::vector<std::array<double, 3>>& centroids);
  Ball ball_of(std::uint32_t begin, std::uint32_t end) const;
  std::array<double, 3> voxels(const GridPoint& p) const;
  // What a ball adds at p, with an error that holds within h of it if the gradient is followed there.
  static Turns far(const Ball& ball, const std::array<double, 3>& p, double h);
  static std::array<double, 3> gradient(const Ball& ball, const std::array<double, 3>& p);
  // Calls take_far(ball, turns) for balls that are far enough and take_near(triangle) for the other triangles.
  template <class TakeFar, class TakeNear>
  void visit(const std::array<double, 3>& p, double h, double tolerance, const TakeFar& take_far,
             const TakeNear& take_near) const;

  const int fraction_bits_;
  const double voxel_;  // of a unit of the grid, exactly
  struct Extent {
    std::array<double, 3> centre;  // voxels
    double radius, area;
  };
  // The gradient of a triangle's solid angle, and a bound of its rounding.
  struct Slope {
    std::array<double, 3> gradient;
    double error;
  };
  Slope slope(const GridTriangle& t, const std::array<double, 3>& p) const;

  std::vector<GridTriangle> triangles_;  // those of a ball stand together
  std::vector<Extent> extents_;          // of the triangles
  std::vector<Ball> balls_;              // parents first, each followed by its first child
  double area_ = 0;
};

}  // namespace blackleaf::detail
