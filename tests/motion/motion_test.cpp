#include "blackleaf/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "blackleaf/error.h"
#include "reference/dense_motion.h"

namespace blackleaf {
namespace {

constexpr double kDegree = M_PI / 180;

TEST(Motion, RotationIsThatOfThePaper) {
  std::mt19937 random(1987);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d n = Eigen::Vector3d(real(random), real(random), real(random)).normalized();
    const double phi = 4 * real(random), c = std::cos(phi), s = std::sin(phi);
    Eigen::Matrix3d r;  // WA87, section 3
    r << (n.x() * n.x() - 1) * (1 - c) + 1, n.x() * n.y() * (1 - c) - n.z() * s, n.x() * n.z() * (1 - c) + n.y() * s,
        n.y() * n.x() * (1 - c) + n.z() * s, (n.y() * n.y() - 1) * (1 - c) + 1, n.y() * n.z() * (1 - c) - n.x() * s,
        n.z() * n.x() * (1 - c) - n.y() * s, n.z() * n.y() * (1 - c) + n.x() * s, (n.z() * n.z() - 1) * (1 - c) + 1;
    EXPECT_LT((Motion::rotation(n * 3, phi).rotation() - r).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(Motion, ComposesAndInverts) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Motion a = reference::random_motion(6, random), b = reference::random_motion(6, random);
    const Eigen::Vector3d x(trial, 3, -5);
    EXPECT_LT(((a * b)(x)-a(b(x))).norm(), 1e-11);
    EXPECT_LT((a.inverse()(a(x)) - x).norm(), 1e-11);
    EXPECT_LT((a.about(x)(x) - (x + a.translation())).norm(), 1e-11);
  }
}

TEST(Motion, QuarterTurnsAndIntegerTranslationsAreExact) {
  constexpr std::int64_t kOne = std::int64_t{1} << FixedMotion::kFractionBits;
  for (const double n : {8.0, 1048576.0})
    for (int axis = 0; axis < 3; ++axis)
      for (int quarter = -4; quarter <= 4; ++quarter) {
        const Motion m = (Motion::translation({3, -5, n / 2}) *
                          Motion::rotation(Eigen::Vector3d::Unit(axis), quarter * 90 * kDegree))
                             .about(Eigen::Vector3d::Constant(n / 2));
        const FixedMotion fixed(m);
        EXPECT_TRUE(fixed.is_lattice_symmetry());
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(fixed.forward_translation[i] % kOne, 0);
        EXPECT_FALSE(FixedMotion(Motion::translation({0.5, 0, 0}) * m).is_lattice_symmetry());
      }
  EXPECT_FALSE(FixedMotion(Motion::rotation({0, 0, 1}, 1e-9)).is_lattice_symmetry());
}

TEST(Motion, RoundingIsWithinHalfAStep) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 500; ++trial) {
    const Motion m = reference::random_motion(10, random);
    const FixedMotion fixed(m);
    const Motion inverse = m.inverse();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_LE(std::abs(std::ldexp(static_cast<double>(fixed.inverse_rotation[i][j]), -38) -
                           inverse.rotation()(static_cast<int>(i), static_cast<int>(j))),
                  0x1p-39 + 1e-16);
      // b follows from the rounded rotation and the rounded translation.
      EXPECT_LE(std::abs(std::ldexp(static_cast<double>(fixed.inverse_translation[i]), -38) -
                         inverse.translation()[static_cast<int>(i)]),
                0x1p-38 + 1024 * 3 * 0x1p-39);
    }
  }
}

TEST(Motion, ShiftingAfterwardsIsExact) {
  const Motion m = Motion::rotation({1, 2, 3}, 0.7).about({100, 200, 300});
  const FixedMotion fixed(m), shifted = fixed.shifted({8, -16, 1 << 20});
  for (std::size_t i = 0; i < 3; ++i) {
    // (A (X + o) + b') = A X + b
    const auto& a = fixed.inverse_rotation[i];
    EXPECT_EQ(a[0] * 8 - a[1] * 16 + a[2] * (1 << 20) + shifted.inverse_translation[i], fixed.inverse_translation[i]);
  }
}

TEST(Motion, RefusesWhatIsNoMotion) {
  const auto code = [](const auto& make) {
    try {
      make();
      return std::string("accepted");
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 1) = 0.01;
  EXPECT_NE(code([&] { Motion(m, {0, 0, 0}); }).find("not a rotation"), std::string::npos);
  m = -Eigen::Matrix3d::Identity();
  EXPECT_NE(code([&] { Motion(m, {0, 0, 0}); }).find("reflection"), std::string::npos);
  m(1, 1) = nan;
  EXPECT_NE(code([&] { Motion(m, {0, 0, 0}); }).find("finite"), std::string::npos);
  EXPECT_NE(code([&] { Motion::translation({nan, 0, 0}); }).find("finite"), std::string::npos);
  EXPECT_NE(code([&] { Motion::rotation({0, 0, 0}, 1); }).find("axis 0,0,0"), std::string::npos);
  EXPECT_NE(code([&] { Motion::rotation({0, 0, 1}, nan); }).find("finite"), std::string::npos);
  EXPECT_NE(code([&] { Motion::rotation(Eigen::Quaterniond(0, 0, 0, 0)); }).find("quaternion"), std::string::npos);
  EXPECT_NE(code([&] { FixedMotion(Motion::translation({9e6, 0, 0})); }).find("2^23"), std::string::npos);
  EXPECT_EQ(code([&] { FixedMotion(Motion::translation({8e6, 0, 0})); }), "accepted");
}

TEST(Motion, SlightlyOffMatricesAreBroughtToTheNearestRotation) {
  Eigen::Matrix3d r = Motion::rotation({1, 2, 3}, 1).rotation();
  r(0, 0) += 1e-7;
  const Motion m(r, {0, 0, 0});
  EXPECT_LT((m.rotation().transpose() * m.rotation() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((m.rotation() - r).cwiseAbs().maxCoeff(), 2e-7);
}

}  // namespace
}  // namespace blackleaf
