// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/thinned_curve.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet {

ThinnedCurve::ThinnedCurve(double duration, double longest_gap, int columns)
    : column_width_(std::max(duration, 1e-9) / columns), longest_gap_(longest_gap) {}

void ThinnedCurve::add(double time, double value) {
  if (!std::isfinite(value) || !std::isfinite(time)) {
    lift();
    return;
  }
  if (samples_ > 0 && time - last_time_ > longest_gap_) lift();
  ++samples_;
  last_time_ = time;
  const CurvePoint point{time, value, false};
  if (open_ && !lifted_ && time < column_end_) {
    if (value < open_->smallest.value) open_->smallest = point;
    if (value > open_->largest.value) open_->largest = point;
    return;
  }
  if (open_) write(*open_, points_);
  open_ = Column{point, point, lifted_};
  column_end_ = (std::floor(time / column_width_) + 1.0) * column_width_;
  lifted_ = false;
}

void ThinnedCurve::lift() {
  lifted_ = true;
}

void ThinnedCurve::write(const Column& column, std::vector<CurvePoint>& points) {
  CurvePoint first = column.smallest;
  CurvePoint second = column.largest;
  if (second.time < first.time) std::swap(first, second);
  first.begins = column.begins;
  points.push_back(first);
  if (second.time > first.time) points.push_back(second);
}

std::vector<CurvePoint> ThinnedCurve::points() const {
  std::vector<CurvePoint> points = points_;
  if (open_) write(*open_, points);
  return points;
}

AngleLine::Angle AngleLine::next(double degrees) {
  constexpr double kTurn = 360.0;
  constexpr double kReach = 190.0;
  if (!std::isfinite(degrees)) return {degrees, false};
  if (!last_) {
    last_ = degrees;
    return {degrees, false};
  }
  const double continued = *last_ + std::remainder(degrees - *last_, kTurn);
  const bool jumps = std::abs(continued) > kReach;
  last_ = jumps ? continued - std::copysign(kTurn, continued) : continued;
  return {*last_, jumps};
}

}  // namespace swiftlet
