// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geometry/so3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

/// Random directions, each with angles from none to almost half a turn.
std::vector<Vector3d> rotation_vectors() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> vectors{Vector3d::Zero()};
  for (const double angle : {1e-300, 1e-12, 1e-8, 1e-5, 0.9e-4, 1.1e-4, 1e-3, 0.049, 0.051, 0.199,
                             0.201, 1.0, 2.0, 3.0, kPi - 1e-3, kPi - 1e-9}) {
    for (int i = 0; i < 5; ++i) {
      vectors.push_back(angle *
                        Vector3d(normal(random), normal(random), normal(random)).normalized());
    }
  }
  return vectors;
}

/// Exponential by its series: an oracle without trigonometry.
Matrix3d exp_series(const Vector3d& phi) {
  Matrix3d sum = Matrix3d::Identity(), term = Matrix3d::Identity();
  for (int n = 1; n < 60; ++n) sum += term = (term * hat(phi) / n).eval();
  return sum;
}

/// Integral over s from 0 to 1 of f(s), Gauss-Legendre with 5 nodes on 40 intervals.
template <class F>
Matrix3d integral(F f) {
  const double x[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  const double w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  constexpr int kIntervals = 40;
  Matrix3d sum = Matrix3d::Zero();
  for (int i = 0; i < kIntervals; ++i) {
    const double h = 0.5 / kIntervals, c = (2 * i + 1) * h;
    sum += h * w[0] * f(c);
    for (int k = 1; k < 3; ++k) sum += h * w[k] * (f(c + h * x[k]) + f(c - h * x[k]));
  }
  return sum;
}

TEST(So3, HatIsTheCrossProductAndVeeItsInverse) {
  const Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_EQ(hat(a) * b, a.cross(b));
  EXPECT_EQ(vee(hat(a)), a);
  const Matrix3d symmetric = a * a.transpose();
  EXPECT_EQ(vee(hat(a) + symmetric), a);
}

TEST(So3, ExpIsTheMatrixExponential) {
  for (const Vector3d& phi : rotation_vectors()) {
    EXPECT_LT((exp_so3(phi).toRotationMatrix() - exp_series(phi)).norm(), 1e-13) << phi.transpose();
    EXPECT_NEAR(exp_so3(phi).norm(), 1.0, 1e-15);
  }
}

TEST(So3, LogInvertsExpAndForgetsTheSignOfTheQuaternion) {
  for (const Vector3d& phi : rotation_vectors()) {
    const Quaterniond q = exp_so3(phi);
    EXPECT_LT((log_so3(q) - phi).norm(), 1e-12 + 1e-9 * phi.norm()) << phi.transpose();
    const Vector3d from_negative = log_so3(Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()));
    EXPECT_LT((from_negative - phi).norm(), 1e-12 + 1e-9 * phi.norm()) << phi.transpose();
  }
}

TEST(So3, LeftJacobianIsTheIntegralOfExp) {
  for (const Vector3d& phi : rotation_vectors()) {
    const Matrix3d oracle = integral([&](double s) { return exp_series(s * phi); });
    EXPECT_LT((left_jacobian_so3(phi) - oracle).norm(), 1e-12) << phi.transpose();
  }
}

TEST(So3, LeftJacobianIsTheDerivativeOfExp) {
  const Vector3d phi(0.7, -1.1, 0.4);
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = 1e-6 * Vector3d::Unit(i);
    const Vector3d moved = log_so3(exp_so3(phi + d) * exp_so3(phi).conjugate());
    EXPECT_LT((moved - left_jacobian_so3(phi) * d).norm(), 1e-11);
  }
}

TEST(So3, LeftJacobianIntegralIsTheSecondIntegralOfExp) {
  for (const Vector3d& phi : rotation_vectors()) {
    // By parts: the double integral of exp is the integral of (1 - s) exp(s phi).
    const Matrix3d oracle =
        integral([&](double s) { return Matrix3d((1.0 - s) * exp_series(s * phi)); });
    EXPECT_LT((left_jacobian_integral_so3(phi) - oracle).norm(), 1e-12) << phi.transpose();
  }
}

TEST(So3, YawIsWhereTheNosePoints) {
  for (double yaw = -3.1; yaw < 3.2; yaw += 0.1) {
    const Quaterniond q = from_yaw(yaw) * exp_so3({0.0, 0.4, 0.0}) * exp_so3({-0.3, 0.0, 0.0});
    const Vector3d nose = q * Vector3d::UnitX();
    EXPECT_NEAR(wrap_angle(yaw_of(q) - std::atan2(nose.y(), nose.x())), 0.0, 1e-12);
    EXPECT_NEAR(wrap_angle(yaw_of(q) - yaw), 0.0, 1e-12);
  }
}

TEST(So3, WrapAngleKeepsTheAngleAndItsInterval) {
  for (double angle = -50.0; angle < 50.0; angle += 0.37) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
  }
  EXPECT_EQ(wrap_angle(-kPi), wrap_angle(kPi));
}

}  // namespace
}  // namespace swiftlet
