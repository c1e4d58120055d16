#include "blackleaf/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
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

// The motion itself, backwards: in long double, on which the numbers of a motion lose nothing that counts here.
std::array<long double, 3> taken_from(const Motion& m, const std::array<long double, 3>& x) {
  std::array<long double, 3> result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      result[static_cast<std::size_t>(i)] +=
          static_cast<long double>(m.rotation()(j, i)) *
          (x[static_cast<std::size_t>(j)] - static_cast<long double>(m.translation()[j]));
  return result;
}

TEST(Motion, RoundingKeepsItsBound) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 3000; ++trial) {
    SCOPED_TRACE(trial);
    const int depth = 1 + trial % 20;
    const double n = std::exp2(depth), e = 0x1p-39 * (1 + 0x1p-19);
    const Motion m = trial % 3 == 0
                         ? reference::random_motion(depth, random)
                         : Motion::translation(Eigen::Vector3d(unit(random), unit(random), unit(random)) * n) *
                               Motion::rotation({unit(random), unit(random), unit(random)}, 4 * unit(random));
    const FixedMotion fixed(m);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_LE(std::abs(std::ldexp(static_cast<double>(fixed.inverse_rotation[i][j]), -38) -
                           m.rotation()(static_cast<int>(j), static_cast<int>(i))),
                  e + 1e-16);
    double reach = 0, farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const std::array<long double, 3> x = {corner & 1 ? n : 0, corner & 2 ? n : 0, corner & 4 ? n : 0};
      const auto exact = taken_from(m, x);
      for (std::size_t i = 0; i < 3; ++i) {
        long double rounded = static_cast<long double>(fixed.inverse_translation[i]);
        for (std::size_t j = 0; j < 3; ++j) rounded += static_cast<long double>(fixed.inverse_rotation[i][j]) * x[j];
        farthest = std::max(farthest, static_cast<double>(std::abs(rounded * 0x1p-38L - exact[i])));
        reach = std::max(reach, std::abs(static_cast<double>(x[i]) - m.translation()[static_cast<int>(i)]));
      }
    }
    EXPECT_LE(farthest, e * (3 * reach + 3) + 1e-16 * n);
    EXPECT_LE(farthest, 0x1p-36 * n);
  }
}

TEST(Motion, WhatIsMeantToBeTheMiddleIsRoundedAlike) {
  // 2^-39 is the middle between two grid points. However it is arrived at, it goes away from zero.
  constexpr double kHalf = 0x1p-39;
  std::mt19937 random(39);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const Motion there = reference::random_motion(12, random);
    for (const double steps : {1.0, 3.0, -1.0, -5.0}) {
      const Motion plain = Motion::translation({steps * kHalf, 0, 0});
      const Motion roundabout = there.inverse() * (there * plain);
      EXPECT_EQ(FixedMotion(plain).forward_translation[0], (steps > 0 ? steps + 1 : steps - 1) / 2);
      EXPECT_TRUE(FixedMotion(roundabout) == FixedMotion(plain));
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

std::string refusal(const std::function<void()>& make) {
  try {
    make();
    return "accepted";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Motion, RefusesWhatIsNoMotion) {
  using Eigen::Matrix3d;
  const Eigen::Vector3d origin = {0, 0, 0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [&](const std::function<void()>& make, const std::string& part) {
    EXPECT_NE(refusal(make).find(part), std::string::npos) << refusal(make);
  };
  Matrix3d m = Matrix3d::Identity();
  m.col(1) = Eigen::Vector3d(std::sin(0.01), std::cos(0.01), 0);
  expect([&] { Motion(m, origin); }, "it shears: columns 1 and 2 meet at 89.427 degrees; give a rotation");
  expect([&] { Motion(1.25 * Matrix3d::Identity(), origin); },
         "it scales: its columns have lengths 1.25, 1.25, 1.25; give a rotation and a translation only; scaling and");
  m = Matrix3d::Identity();
  m(0, 1) = 0.1;
  expect([&] { Motion(m, origin); },
         "it scales and shears: its columns have lengths 1, 1.00499, 1, and columns 1 and 2 meet at 84.2894 degrees");
  expect([&] { Motion(Matrix3d::Zero(), origin); }, "lengths 0, 0, 0");
  expect([&] { Motion(Matrix3d::Constant(1e300), origin); }, "scales");
  expect([&] { Motion(Eigen::Vector3d(1, -1, 1).asDiagonal(), origin); },
         "the matrix is not a rotation: it is a reflection along y: its determinant is -1; that is another operation: "
         "--reflect y");
  expect([&] { Motion(-Matrix3d::Identity(), origin); }, "--reflect x,y,z");
  expect(
      [&] {
        Motion(-Motion::rotation({1, 2, 3}, 1).rotation(), origin);
      },
      "it is a reflection: its determinant is -1; reflect the solid along one axis (--reflect x)");
  m(1, 1) = nan;
  expect([&] { Motion(m, origin); }, "not finite");
  expect([&] { Motion::translation({nan, 0, 0}); }, "not finite");
  expect([&] { Motion::rotation({0, 0, 0}, 1); }, "axis 0,0,0");
  expect([&] { Motion::rotation({0, 0, 1}, nan); }, "not a finite");
  expect([&] { Motion::rotation_degrees({0, 0, nan}, 1); }, "not a finite");
  expect([&] { Motion::rotation(Eigen::Quaterniond(0, 0, 0, 0)); }, "quaternion");
  expect([&] { Motion::rotation(Eigen::Quaterniond(nan, 0, 0, 0)); }, "quaternion");
  Eigen::Matrix4d last = Eigen::Matrix4d::Identity();
  last(3, 1) = 0.5;
  expect([&] { Motion::from(last); }, "the last row of a motion's matrix is 0 0.5 0 1, not 0 0 0 1");
  last(3, 1) = nan;
  expect([&] { Motion::from(last); }, "not finite");
  const Motion far = Motion::translation({1e308, 0, 0});
  expect([&] { far* far; }, "not finite");
  expect([&] { FixedMotion(Motion::translation({9e6, 0, 0})); }, "2^23");
  EXPECT_EQ(refusal([&] { FixedMotion(Motion::translation({8e6, 0, 0})); }), "accepted");
  expect([&] { power(Motion(), nan); }, "power");
  expect([&] { power(Motion(), 1e17); }, "power");
}

TEST(Motion, AxesOfAnyLengthAndAnglesOfAnySize) {
  const Eigen::Vector3d axis(1, -2, 0.5);
  const Motion expected = Motion::rotation(axis, 1);
  for (const double length : {1e-300, 1e-5, 3.0, 1e300})
    EXPECT_LT((Motion::rotation(axis * length, 1).rotation() - expected.rotation()).norm(), 1e-15);
  for (const double turns : {1.0, -7.0, 1e4, -1e6, 1e9})
    EXPECT_LT((Motion::rotation(axis, 1 + turns * 2 * M_PI).rotation() - expected.rotation()).norm(),
              1e-15 * (4 + 16 * std::abs(turns)));
  for (const double degrees : {90.0, -270.0, 90.0 + 360.0 * 1e12})
    EXPECT_TRUE(Motion::rotation_degrees({0, 3, 0}, degrees) == Motion::rotation({0, 1, 0}, M_PI / 2));
  EXPECT_TRUE(Motion::rotation_degrees({2, 2, 2}, 120) == Motion::rotation({1, 1, 1}, 2 * M_PI / 3));
}

TEST(Motion, ConvertsToAndFromEverything) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const Motion m = reference::random_motion(7, random);
    const auto near = [&](const Motion& other) {
      EXPECT_LT((other.matrix() - m.matrix()).cwiseAbs().maxCoeff(), 1e-15);
    };
    near(Motion::from(m.matrix()));
    near(Motion::from(Eigen::Isometry3d(m.matrix())));
    near(Motion::translation(m.translation()) * Motion::rotation(m.quaternion()));
    near(Motion::translation(m.translation()) * Motion::rotation(Eigen::Quaterniond(-4e200 * m.quaternion().coeffs())));
    EXPECT_GE(m.quaternion().w(), 0);
  }
}

TEST(Motion, WholePowersAreRepeatedComposition) {
  std::mt19937 random(21);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const Motion m = reference::random_motion(6, random);
    Motion repeated;
    for (int k = 0; k <= 40; ++k) {
      EXPECT_TRUE(FixedMotion(power(m, k)) == FixedMotion(repeated)) << k;
      EXPECT_TRUE(FixedMotion(power(m, -k)) == FixedMotion(repeated.inverse())) << k;
      repeated = m * repeated;
    }
    EXPECT_TRUE(power(m, 0) == Motion());
    EXPECT_TRUE(power(m, 1) == m);
  }
  EXPECT_EQ(FixedMotion(power(Motion::rotation_degrees({1, 2, 3}, 0.5).about({5, 6, 7}), 720 * 1e9)),
            FixedMotion(Motion()));
  EXPECT_EQ(power(Motion::translation({0.5, -1, 3}), 1e6).translation(), Eigen::Vector3d(5e5, -1e6, 3e6));
}

TEST(Motion, PowersAddUpAndAreScrews) {
  std::mt19937 random(22);
  std::uniform_real_distribution<double> real(-3, 3);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::Vector3d axis = Eigen::Vector3d(real(random), real(random), real(random)).normalized();
    const Eigen::Vector3d point(9 * real(random), real(random), real(random));
    // From next to nothing to nearly 180 degrees.
    const double angle = trial % 4 == 0   ? std::exp2(-trial / 10.0)
                         : trial % 4 == 1 ? M_PI - std::exp2(-trial / 12.0)
                                          : std::abs(real(random));
    const double pitch = real(random), s = real(random), t = real(random);
    const auto screw = [&](double part) {
      return (Motion::translation(part * pitch * axis) * Motion::rotation(axis, part * angle)).about(point);
    };
    const Motion m = screw(1);
    const auto near = [](const Motion& a, const Motion& b, double by) {
      EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), by);
    };
    near(power(m, t), screw(t), 1e-12);
    near(power(m, s) * power(m, t), power(m, s + t), 1e-12);
    near(power(m, -t), power(m, t).inverse(), 1e-15);
    near(power(power(m, 0.25), 4), m, 1e-12);
  }
  // A half turn: R^0.5 goes one way, the same for both signs of the axis, and its square is the half turn.
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, -3, 4), Eigen::Vector3d(-1, 2, -2)}) {
    const Motion half = Motion::rotation(axis, M_PI).about({1, 2, 3});
    EXPECT_LT((power(half, 0.5).matrix() - Motion::rotation(-axis, M_PI / 2).about({1, 2, 3}).matrix()).norm() *
                  (power(half, 0.5).matrix() - Motion::rotation(axis, M_PI / 2).about({1, 2, 3}).matrix()).norm(),
              1e-13);
    EXPECT_LT((power(half, 0.5).matrix() - power(half.inverse(), 0.5).matrix()).norm(), 1e-14);
    EXPECT_LT((power(power(half, 0.5), 2).matrix() - half.matrix()).norm(), 1e-14);
  }
}

TEST(Motion, InterpolationIsStraightAndSlerp) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const Motion from = reference::random_motion(6, random), to = reference::random_motion(6, random);
    const Eigen::Vector3d about = 64 * Eigen::Vector3d(unit(random), unit(random), unit(random));
    EXPECT_TRUE(interpolate(from, to, 0, about) == from);
    EXPECT_TRUE(interpolate(from, to, 1, about) == to);
    const double t = unit(random);
    const Motion between = interpolate(from, to, t, about);
    EXPECT_LT((between(about) - ((1 - t) * from(about) + t * to(about))).norm(), 1e-12);
    const double whole = from.quaternion().angularDistance(to.quaternion());
    if (whole < M_PI - 1e-6) {
      const Eigen::Quaterniond slerp = from.quaternion().slerp(t, to.quaternion());
      EXPECT_LT(between.quaternion().angularDistance(slerp), 1e-7);
      EXPECT_LT((between.rotation() - slerp.toRotationMatrix()).norm(), 1e-13);
    }
    EXPECT_NEAR(from.quaternion().angularDistance(between.quaternion()), t * whole, 1e-7);
    // The same way back.
    if (whole < M_PI - 1e-6) {
      EXPECT_LT((interpolate(to, from, 1 - t, about).matrix() - between.matrix()).norm(), 1e-12);
    }
  }
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
