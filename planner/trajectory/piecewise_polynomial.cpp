// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/piecewise_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace swiftlet {
namespace {

/// Degree of the squared norm of a derivative.
constexpr int kSquareSize = 2 * kCoefficients - 1;
using SquarePolynomial = Eigen::Matrix<double, kSquareSize, 1>;

/// Relative width at which the search for a maximum ends, and its bound on work.
constexpr double kTolerance = 1e-6;
constexpr int kMaxSubdivisions = 2000;

/// Coefficients of the `order`-th derivative in s.
Polynomial differentiate(Polynomial c, int order) {
  for (int k = 0; k < order; ++k) {
    for (int i = 0; i + 1 < kCoefficients; ++i) c[i] = (i + 1) * c[i + 1];
    c[kCoefficients - 1] = 0.0;
  }
  return c;
}

double horner(const Polynomial& c, double s) {
  double value = 0.0;
  for (int i = kCoefficients - 1; i >= 0; --i) value = value * s + c[i];
  return value;
}

/// Power basis on [0, 1] to Bernstein basis: b_j = sum_i C(j, i) / C(n, i) a_i.
SquarePolynomial to_bernstein(const SquarePolynomial& a) {
  constexpr int n = kSquareSize - 1;
  SquarePolynomial b;
  for (int j = 0; j <= n; ++j) {
    double ratio = 1.0, sum = 0.0;  // C(j, i) / C(n, i)
    for (int i = 0; i <= j; ++i) {
      sum += ratio * a[i];
      ratio *= static_cast<double>(j - i) / (n - i);
    }
    b[j] = sum;
  }
  return b;
}

/// A piece of the interval, with the polynomial in its Bernstein form: its largest coefficient is
/// above every value on the piece, its first and last are values that are taken.
struct Piece {
  SquarePolynomial b;
  double above;
  explicit Piece(const SquarePolynomial& bernstein) : b(bernstein), above(b.maxCoeff()) {}
  double taken() const { return std::max(b[0], b[kSquareSize - 1]); }
  bool operator<(const Piece& other) const { return above < other.above; }
};

/// De Casteljau's subdivision in the middle.
std::pair<Piece, Piece> halves(const Piece& piece) {
  SquarePolynomial left, right = piece.b;
  for (int k = 0; k < kSquareSize; ++k) {
    left[k] = right[0];
    for (int i = 0; i + 1 < kSquareSize - k; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
  }
  return {Piece(left), Piece(right)};
}

/// Least upper bound of the polynomial on [0, 1] that branch and bound gives within the tolerance.
double upper_bound(const SquarePolynomial& power) {
  std::priority_queue<Piece> pieces;
  pieces.emplace(to_bernstein(power));
  double taken = pieces.top().taken();
  for (int k = 0; k < kMaxSubdivisions; ++k) {
    const Piece top = pieces.top();
    if (top.above <= taken + kTolerance * std::abs(taken) + 1e-18) break;
    pieces.pop();
    const auto [left, right] = halves(top);
    taken = std::max({taken, left.taken(), right.taken()});
    pieces.push(left);
    pieces.push(right);
  }
  return std::max(taken, pieces.top().above);
}

bool is_sound(const TrajectorySegment& segment) {
  // An hour for a piece is more than any battery gives; it keeps sums of durations in range.
  if (!(segment.duration_s > 0.0 && segment.duration_s < 3600.0)) return false;
  for (const Polynomial& c : segment.coefficients) {
    if (!c.allFinite()) return false;
  }
  return true;
}

}  // namespace

Trajectory::Trajectory(Time start, std::vector<TrajectorySegment> segments) : start_(start) {
  double total_s = 0.0;
  for (const TrajectorySegment& segment : segments) {
    if (!is_sound(segment)) return;
    total_s += segment.duration_s;
  }
  segments_ = std::move(segments);
  duration_ = from_seconds(total_s);
}

double derivative(const TrajectorySegment& segment, int axis, double s, int order) {
  const Polynomial& c = segment.coefficients[static_cast<std::size_t>(axis)];
  return horner(differentiate(c, order), s) / std::pow(segment.duration_s, order);
}

FlatReference Trajectory::evaluate(Time time) const {
  FlatReference reference;
  if (empty()) return reference;
  const bool before = time<start_, after = time> end();
  double left_s = std::clamp(to_seconds(time - start_), 0.0, to_seconds(duration_));
  std::size_t i = 0;
  while (i + 1 < segments_.size() && left_s >= segments_[i].duration_s) {
    left_s -= segments_[i++].duration_s;
  }
  const TrajectorySegment& segment = after ? segments_.back() : segments_[i];
  const double s = after ? 1.0 : std::min(left_s / segment.duration_s, 1.0);
  Eigen::Matrix<double, 5, 4> values = Eigen::Matrix<double, 5, 4>::Zero();
  for (int axis = 0; axis < 4; ++axis) {
    Polynomial c = segment.coefficients[static_cast<std::size_t>(axis)];
    double scale = 1.0;
    for (int order = 0; order < ((before || after) ? 1 : 5); ++order) {
      values(order, axis) = horner(c, s) * scale;
      c = differentiate(c, 1);
      scale /= segment.duration_s;
    }
  }
  reference.position = values.block<1, 3>(0, 0).transpose();
  reference.velocity = values.block<1, 3>(1, 0).transpose();
  reference.acceleration = values.block<1, 3>(2, 0).transpose();
  reference.jerk = values.block<1, 3>(3, 0).transpose();
  reference.snap = values.block<1, 3>(4, 0).transpose();
  reference.yaw = values(0, kYaw);
  reference.yaw_rate = values(1, kYaw);
  reference.yaw_acceleration = values(2, kYaw);
  return reference;
}

double max_derivative_norm(const TrajectorySegment& segment, int order) {
  SquarePolynomial square = SquarePolynomial::Zero();
  for (std::size_t axis = kX; axis <= kZ; ++axis) {
    const Polynomial c = differentiate(segment.coefficients[axis], order);
    for (int i = 0; i < kCoefficients; ++i) {
      for (int j = 0; j < kCoefficients; ++j) square[i + j] += c[i] * c[j];
    }
  }
  return std::sqrt(std::max(0.0, upper_bound(square))) / std::pow(segment.duration_s, order);
}

double Trajectory::max_speed() const {
  double speed = 0.0;
  for (const auto& segment : segments_) speed = std::max(speed, max_derivative_norm(segment, 1));
  return speed;
}

double Trajectory::max_acceleration() const {
  double acceleration = 0.0;
  for (const auto& segment : segments_) {
    acceleration = std::max(acceleration, max_derivative_norm(segment, 2));
  }
  return acceleration;
}

Trajectory resting_at(const FlatReference& reference, Time end) {
  TrajectorySegment segment;
  segment.duration_s = 1.0;
  segment.coefficients[kX][0] = reference.position.x();
  segment.coefficients[kY][0] = reference.position.y();
  segment.coefficients[kZ][0] = reference.position.z();
  segment.coefficients[kYaw][0] = reference.yaw;
  return Trajectory(end - std::chrono::seconds(1), {segment});
}

}  // namespace swiftlet
