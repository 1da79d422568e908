// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/trajectory/piecewise_polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "planner/trajectory/bernstein.hpp"

namespace swiftlet {
namespace {

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
    add_square(differentiate(segment.coefficients[axis], order), square);
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
