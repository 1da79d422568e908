// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/inertial_carry.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Beyond these a sample is broken: three times what the parts on such vehicles measure.
constexpr double kMaxAngularVelocity = 100.0;  // [rad/s]
constexpr double kMaxSpecificForce = 500.0;    // [m/s^2]
// Beyond these a state means nothing; the limits keep it finite.
constexpr double kMaxSpeed = 200.0;   // [m/s]
constexpr double kMaxDistance = 1e6;  // each axis [m]
constexpr double kMaxAhead = 0.2;     // odometry may run ahead by what samples are late [s]
// Odometry that is further off the observer, or comes after a longer gap, is another estimate: the
// observer starts again from it, with the errors that it knows.
constexpr double kMaxInterval = 0.5;            // [s]
constexpr double kMaxVelocityDifference = 0.5;  // [m/s]
constexpr double kMaxAngle = 0.2;               // [rad]
// At the start the observer is as slow as there was odometry to observe.
constexpr double kShortestTimeConstant = 0.2;  // [s]
constexpr double kShareOfTime = 0.5;

bool believable(const Vector3d& v, double limit) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= limit;
}

Vector3d limited(const Vector3d& v, double limit) {
  const double n = v.norm();
  return n > limit ? Vector3d(v * (limit / n)) : v;
}

}  // namespace

InertialCarry::InertialCarry(const Params& params) {
  set_params(params);
}

void InertialCarry::set_params(const Params& params) {
  const auto within = [](double v, double least, double most) { return v >= least && v <= most; };
  if (!within(params.attitude_time_constant, 0.2, 1e3) ||
      !within(params.velocity_time_constant, 0.2, 1e3) ||
      !within(params.max_accelerometer_error, 0.0, kGravity) ||
      !within(params.max_gyroscope_error, 0.0, 1.0) || !within(params.max_gap, 1e-3, 1.0)) {
    throw std::invalid_argument(
        "inertial carry: time constants must be from 0.2 to 1000 s, max_accelerometer_error from 0 "
        "to 9.81 m/s^2, max_gyroscope_error from 0 to 1 rad/s, max_gap from 0.001 to 1 s");
  }
  params_ = params;
  accelerometer_error_ = limited(accelerometer_error_, params.max_accelerometer_error);
  gyroscope_error_ = limited(gyroscope_error_, params.max_gyroscope_error);
}

void InertialCarry::correct(Time time, const RigidBodyState& odometry) {
  const bool usable = believable(odometry.p_WB, kMaxDistance) &&
                      believable(odometry.v_WB_W, kMaxSpeed) &&
                      std::abs(odometry.q_WB.norm() - 1.0) < 1e-3;
  if (!usable) return;
  observe(time, odometry);
  const Vector3d angular_velocity = state_.w_WB_B;  // the gyroscope's is newer
  state_ = odometry;
  state_.q_WB.normalize();
  state_.w_WB_B = angular_velocity;
  time_ = time;
  odometry_time_ = time;
  motion_known_ = true;
  let_go_ = false;
  without_sample_ = 0.0;
}

/// Two critically damped observers, one step each. Errors of the gyroscope turn the attitude, and
/// those of the accelerometer change the velocity, by their integral.
void InertialCarry::observe(Time time, const RigidBodyState& odometry) {
  const double interval = odometry_time_ ? to_seconds(time - *odometry_time_) : 0.0;
  if (odometry_time_ && interval <= 0.0) return;
  // The observer stands at the last sample; odometry is a little older or newer.
  const double ahead = time_ ? std::clamp(to_seconds(time - *time_), -kMaxAhead, kMaxAhead) : 0.0;
  observed_ = carried(observed_, corrected(imu_), ahead);
  const Vector3d velocity = odometry.v_WB_W - observed_.v_WB_W;
  const Vector3d turn = log_so3(observed_.q_WB.conjugate() * odometry.q_WB);
  const bool goes_on = motion_known_ && has_imu_ && interval <= kMaxInterval &&
                       velocity.norm() <= kMaxVelocityDifference && turn.norm() <= kMaxAngle;
  if (!goes_on) {
    observed_ = {odometry.q_WB.normalized(), odometry.v_WB_W};
    return;
  }
  observed_for_ += interval;
  const double slowest = std::max(kShareOfTime * observed_for_, kShortestTimeConstant);
  const double t_q = std::min(slowest, params_.attitude_time_constant);
  const double t_v = std::min(slowest, params_.velocity_time_constant);
  const auto share = [&](double t) { return std::min(1.0, 2.0 * interval / t); };
  const auto integrated = [&](double t) { return std::min(interval, 0.5 * t) / (t * t); };
  const Vector3d velocity_B = observed_.q_WB.conjugate() * velocity;
  accelerometer_error_ =
      limited(accelerometer_error_ - velocity_B * integrated(t_v), params_.max_accelerometer_error);
  gyroscope_error_ =
      limited(gyroscope_error_ - turn * integrated(t_q), params_.max_gyroscope_error);
  observed_.v_WB_W += velocity * share(t_v);
  observed_.q_WB = (observed_.q_WB * exp_so3(turn * share(t_q))).normalized();
}

void InertialCarry::let_go() {
  if (let_go_ || !motion_known_) return;
  let_go_ = true;
  state_.q_WB = observed_.q_WB;
  state_.v_WB_W = observed_.v_WB_W;
}

ImuSample InertialCarry::corrected(const ImuSample& sample) const {
  return {sample.angular_velocity - gyroscope_error_, sample.specific_force - accelerometer_error_};
}

void InertialCarry::advance(Time now, const ImuSample& imu) {
  const double dt = time_ ? to_seconds(now - *time_) : 0.0;
  const double step = std::clamp(dt, 0.0, params_.max_gap);
  const bool turns = believable(imu.angular_velocity, kMaxAngularVelocity);
  const bool accelerates = believable(imu.specific_force, kMaxSpecificForce);
  ImuSample next = imu_;
  if (turns) next.angular_velocity = imu.angular_velocity;
  if (accelerates) next.specific_force = imu.specific_force;
  without_sample_ = turns && accelerates ? 0.0 : without_sample_ + step;
  if (dt > params_.max_gap || without_sample_ > params_.max_gap) motion_known_ = false;

  ImuSample mean = next;
  if (has_imu_) {
    mean.angular_velocity = 0.5 * (imu_.angular_velocity + next.angular_velocity);
    mean.specific_force = 0.5 * (imu_.specific_force + next.specific_force);
  }
  if (step > 0.0) {
    const Motion before{state_.q_WB, state_.v_WB_W};
    const Motion after = carried(before, corrected(mean), step);
    observed_ = carried(observed_, corrected(mean), step);
    state_.q_WB = after.q_WB;
    if (motion_known_) {
      state_.v_WB_W = after.v_WB_W;
      state_.p_WB += 0.5 * (before.v_WB_W + after.v_WB_W) * step;
      state_.p_WB = state_.p_WB.cwiseMax(-kMaxDistance).cwiseMin(kMaxDistance);
    }
  }
  imu_ = next;
  has_imu_ = has_imu_ || (turns && accelerates);
  state_.w_WB_B = next.angular_velocity;
  if (!time_ || dt > 0.0 || dt < -kMaxAhead) time_ = now;
}

InertialCarry::Motion InertialCarry::carried(const Motion& from, const ImuSample& mean, double dt) {
  const Quaterniond half_turn = exp_so3(mean.angular_velocity * (0.5 * dt));
  const Quaterniond q_middle = from.q_WB * half_turn;
  const Vector3d acceleration = q_middle * mean.specific_force - Vector3d(0.0, 0.0, kGravity);
  return {(q_middle * half_turn).normalized(), limited(from.v_WB_W + acceleration * dt, kMaxSpeed)};
}

}  // namespace swiftlet
