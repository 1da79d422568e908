// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/phone/jump_absorber.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;

/// Of the difference of two measurements with these deviations.
double combined(double a, double b) {
  return std::sqrt(a * a + b * b);
}

/// `error` brought nearer to zero by `step`, and zero exactly where that is enough.
Vector3d shrunk(const Vector3d& error, double step) {
  const double length = error.norm();
  return length <= step ? Vector3d(Vector3d::Zero()) : Vector3d(error * (1.0 - step / length));
}
double shrunk(double error, double step) {
  return std::abs(error) <= step ? 0.0 : error - std::copysign(step, error);
}

}  // namespace

JumpAbsorber::Output JumpAbsorber::follow(const Measurement& measurement) {
  if (!last_ || (leads_to(*last_, measurement) && !belongs_to_candidates(measurement))) {
    candidates_.clear();
    advance(measurement);
    followed_ = std::min(followed_ + 1, params_.confirmations);
    return {Outcome::kFollowed, *output_, {}};
  }
  if (!candidates_.empty() && !leads_to(candidates_.back(), measurement)) candidates_.clear();
  candidates_.push_back(measurement);
  if (static_cast<int>(candidates_.size()) < params_.confirmations) return {};
  if (followed_ < params_.confirmations) return {Outcome::kFalseStart, {}, {}};
  const Jump jump = absorb();
  candidates_.clear();
  return {Outcome::kJumped, *output_, jump};
}

/// The longer poses are withheld, the further motion could have led from before them; so it is also
/// asked which of the two places is nearer.
bool JumpAbsorber::belongs_to_candidates(const Measurement& measurement) const {
  if (candidates_.empty() || !leads_to(candidates_.back(), measurement)) return false;
  const auto way = [&](const Measurement& from) {  // [s]
    return (measurement.pose.position - from.pose.position).norm() / params_.max_speed +
           measurement.pose.attitude.angularDistance(from.pose.attitude) / params_.max_turn_rate;
  };
  return way(candidates_.back()) < way(*last_);
}

bool JumpAbsorber::leads_to(const Measurement& from, const Measurement& to) const {
  const double farthest = params_.max_speed * to_seconds(to.time - from.time) +
                          params_.sigmas * combined(from.position_sigma, to.position_sigma);
  return (to.pose.position - from.pose.position).norm() <= farthest && turns_to(from, to);
}

bool JumpAbsorber::turns_to(const Measurement& from, const Measurement& to) const {
  const double widest = params_.max_turn_rate * to_seconds(to.time - from.time) +
                        params_.sigmas * combined(from.attitude_sigma, to.attitude_sigma);
  return to.pose.attitude.angularDistance(from.pose.attitude) <= widest;
}

/// The output goes on from where it was, by the motion that the candidates show, as if the first of
/// them were there.
JumpAbsorber::Jump JumpAbsorber::absorb() {
  const Measurement before = *last_;
  const Measurement first = candidates_.front();
  const Measurement& newest = candidates_.back();
  Jump jump;
  if (!turns_to(before, first)) {
    jump.yaw = wrap_angle(yaw_of(first.pose.attitude) - yaw_of(before.pose.attitude));
  }
  remaining_yaw_ = wrap_angle(remaining_yaw_ - jump.yaw);

  const double seen = to_seconds(newest.time - first.time);
  Vector3d velocity = Vector3d::Zero();
  if (seen > 0.0) velocity = (newest.pose.position - first.pose.position) / seen;
  const Vector3d moved = velocity * to_seconds(first.time - before.time);
  jump.translation = first.pose.position - (before.pose.position + from_yaw(-jump.yaw) * moved);
  remaining_ = output_->position + from_yaw(remaining_yaw_) * moved - first.pose.position;

  last_ = first;
  for (const Measurement& candidate : candidates_) advance(candidate);
  return jump;
}

void JumpAbsorber::advance(const Measurement& measurement) {
  if (last_) {
    const Vector3d moved = measurement.pose.position - last_->pose.position;
    remaining_ += from_yaw(remaining_yaw_) * moved - moved;
    const double passed = to_seconds(measurement.time - last_->time);
    remaining_ = shrunk(remaining_, params_.follow_speed * passed);
    remaining_yaw_ = shrunk(remaining_yaw_, params_.follow_turn_rate * passed);
  }
  last_ = measurement;
  output_ = Pose{measurement.pose.position + remaining_,
                 (from_yaw(remaining_yaw_) * measurement.pose.attitude).normalized()};
}

}  // namespace swiftlet
