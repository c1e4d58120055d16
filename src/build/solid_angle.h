// Solid angles of triangles, in turns (units of 4 pi), with bounds of their errors.
#pragma once

#include "double_double.h"
#include "grid_mesh.h"

namespace blackleaf::detail {

struct GridTriangle {
  GridPoint a, b, c;
};

struct Turns {
  double value = 0, error = 0;  // the truth differs from the value by at most the error
};

/// The solid angle of a triangle seen from a point, positive from behind, where the triangle faces away; at most 1/2 in
/// size. A point in the triangle's plane counts as moved by an infinitesimal (e, e^2, e^3). In floating point (Van
/// Oosterom and Strackee 1983), in integers where the sign is in doubt. Requires: the triangle has an area.
Turns solid_angle(const GridPoint& p, const GridTriangle& t);

/// A sum of solid angles in double-double arithmetic: half of each is the argument of a complex number without inverse
/// functions (Van Oosterom and Strackee), so the sum is the argument of their product and the times it has gone round.
/// Addition, multiplication, division and square root only, so all machines agree.
class AngleSum {
 public:
  /// Adds what solid_angle() approximates; on the triangle's rim the limit along (e, e^2, e^3).
  void add(const GridPoint& p, const GridTriangle& t);
  /// The least integer greater than the sum plus 1/2. A sum that lies between two integers as nearly as can be told
  /// counts as doing so.
  int above_half() const;

 private:
  void multiply(DoubleDouble re, DoubleDouble im, double error);
  void add_half_turn(int sign);
  bool upper() const;  // the argument lies in (0, pi]

  DoubleDouble re_{1, 0}, im_{0, 0};
  int revolutions_ = 0;  // times the argument has passed pi upward, less downward
  double error_ = 0;     // of the argument
};

}  // namespace blackleaf::detail
