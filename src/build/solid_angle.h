// Solid angles of triangles, in turns (units of 4 pi), with bounds of their errors.
#pragma once

#include "grid_mesh.h"
#include "octree/double_double.h"

namespace blackleaf::detail {

struct GridTriangle {
  GridPoint a, b, c;
};

struct Turns {
  double value = 0, error = 0;  // the truth differs from the value by at most the error
};

/// A sum of solid angles of triangles seen from points, in floating point with a bound of its error. A triangle adds at
/// most 1/2 in size, more than 0 if it is seen from behind, where it does not face. A point in its plane counts as
/// moved by an infinitesimal (e, e^2, e^3). Half a solid angle is the argument of a complex number (Van Oosterom and
/// Strackee 1983; in integers where its sign is in doubt); the numbers are multiplied and the times that the product
/// goes round counted, so that all triangles together need one inverse function.
class QuickSum {
 public:
  /// Requires: the triangle has an area.
  void add(const GridPoint& p, const GridTriangle& t);
  void add(const Turns& turns) {
    value_ += turns.value;
    error_ += turns.error + 0x1p-40 * std::abs(turns.value);
  }
  /// The error of a sum of halves that is found exactly is 0.
  Turns turns() const;

 private:
  double re_ = 1, im_ = 0;  // not 0; of any size
  int rounds_ = 0;          // times the argument has passed pi upward, less downward
  double value_ = 0;        // what is not in the argument
  double error_ = 0;
};

/// The same sum in double-double arithmetic, by the product and its rounds alone, without inverse functions.
/// Addition, multiplication, division and square root only, so all machines agree.
class AngleSum {
 public:
  /// On the triangle's rim, the limit along (e, e^2, e^3).
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
