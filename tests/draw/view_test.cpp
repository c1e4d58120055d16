// View: which directions are kept, and the picture's axes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "blackleaf/drawing.h"
#include "blackleaf/error.h"

namespace blackleaf {
namespace {

using Whole = std::array<std::int64_t, 3>;

TEST(View, WholeDirectionsAreKeptAndReduced) {
  EXPECT_EQ(View({12, -16, 15}).direction(), (Whole{12, -16, 15}));
  EXPECT_EQ(View({12, -16, 20}).direction(), (Whole{3, -4, 5}));
  EXPECT_EQ(View({0, 0, -7}).direction(), (Whole{0, 0, -1}));
  EXPECT_EQ(View({-0.0, 5, 0}).direction(), (Whole{0, 1, 0}));
  EXPECT_EQ(View({1048576, 1, -1048575}).direction(), (Whole{1048576, 1, -1048575}));
  // Large, but small after division by their greatest common divisor.
  EXPECT_EQ(View({3e15, -6e15, 0}).direction(), (Whole{1, -2, 0}));
}

TEST(View, OtherDirectionsAreRoundedToTheirLargestComponent) {
  EXPECT_EQ(View({0.5, 1, 0.25}).direction(), (Whole{2, 4, 1}));
  EXPECT_EQ(View({0.5, 1, 0.2}).direction(), (Whole{524288, 1048576, 209715}));
  EXPECT_EQ(View({0.1, -0.1, 0.1}).direction(), (Whole{1, -1, 1}));
  EXPECT_EQ(View({1e300, -1e300, 0}).direction(), (Whole{1, -1, 0}));
  EXPECT_EQ(View({1e-300, 0, 5e-301}).direction(), (Whole{2, 0, 1}));
  EXPECT_EQ(View({1, 1e-9, 0}).direction(), (Whole{1, 0, 0}));
  // Whole, but beyond 2^20; halves are rounded away from zero.
  EXPECT_EQ(View({2097152, 1, 1048577}).direction(), (Whole{1048576, 1, 524289}));
}

TEST(View, RoundingIsWithinHalfAStep) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(i);
    const Eigen::Vector3d d(any(random), any(random), any(random));
    const Whole w = View(d).direction();
    const Eigen::Vector3d kept(static_cast<double>(w[0]), static_cast<double>(w[1]), static_cast<double>(w[2]));
    const Eigen::Vector3d error = kept / kept.cwiseAbs().maxCoeff() - d / d.cwiseAbs().maxCoeff();
    EXPECT_LE(error.cwiseAbs().maxCoeff(), std::ldexp(0.5, -20) * (1 + 1e-9));
  }
}

TEST(View, RejectsNoDirection) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(infinity, 1, 0), Eigen::Vector3d(1, nan, 1),
        Eigen::Vector3d(nan, 0, 0), Eigen::Vector3d(-infinity, infinity, 0)}) {
    try {
      const View view(d);
      ADD_FAILURE() << "accepted " << d.transpose();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    }
  }
}

TEST(View, AxesAreARightHandedFrame) {
  std::mt19937 random(8);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(i);
    const auto pick = [&] { return static_cast<double>(std::uniform_int_distribution<int>(-3, 3)(random)); };
    Eigen::Vector3d d(pick(), pick(), pick());
    if (d.isZero()) continue;
    const View view(d);
    d.normalize();
    const Eigen::Vector3d up = d[0] == 0 && d[1] == 0 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d right = up.cross(d).normalized();
    EXPECT_LT((view.right() - right).norm(), 1e-15);
    EXPECT_LT((view.up() - d.cross(right)).norm(), 1e-15);
    EXPECT_GE(view.up().dot(up), 0);
  }
}

}  // namespace
}  // namespace blackleaf
