// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/se3_controller.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "control/flatness.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Beyond these, a reference is a mistake; it is limited so that no product overflows.
constexpr double kMaxJerk = 1e3;   // [m/s^3]
constexpr double kMaxSnap = 1e5;   // [m/s^4]
constexpr double kMaxInput = 1e6;  // of any state or reference, in its unit
constexpr double kSteepest = 1.4;  // of a commanded force [rad]; the heading is singular at pi/2

Vector3d limited_norm(const Vector3d& v, double limit) {
  const double n = v.norm();
  return n > limit ? Vector3d(v * (limit / n)) : v;
}

bool usable(const Vector3d& v) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= kMaxInput;
}

bool usable(const Eigen::Quaterniond& q) {
  return q.coeffs().allFinite() && std::abs(q.squaredNorm() - 1.0) < 0.1;
}

bool usable(const FlatReference& r) {
  return usable(r.position) && usable(r.velocity) && usable(r.acceleration) && r.jerk.allFinite() &&
         r.snap.allFinite() && usable(Vector3d(r.yaw, r.yaw_rate, 0.0)) &&
         std::isfinite(r.yaw_acceleration);
}

/// How much of the commanded rates to follow, from the cosine of the angle between the body's and
/// the commanded z axis: all of them near the reference, none where attitude must come first. A
/// reference whose derivatives contradict it can thus not push the vehicle over.
double feed_forward_trust(double cosine) {
  constexpr double kFull = 0.95;  // 18 degrees
  constexpr double kNone = 0.75;  // 41 degrees
  return std::clamp((cosine - kNone) / (kFull - kNone), 0.0, 1.0);
}

Vector3d bounded(const Vector3d& v) {
  return v.cwiseMax(-kMaxInput).cwiseMin(kMaxInput);
}

}  // namespace

Vector3d attitude_error(const Matrix3d& R_WB, const Matrix3d& R_WC) {
  // Half of (A - A^T)^vee; vee takes half of the skew-symmetric part itself.
  return vee(R_WC.transpose() * R_WB);
}

Se3Controller::Se3Controller(const Params& params, const QuadrotorModel& model)
    : params_(params), model_(model) {
  const auto positive = [](const auto& v) { return (Eigen::Array3d(v) > 0.0).all(); };
  const double limits[] = {params.max_integral_acceleration,
                           params.min_specific_thrust,
                           params.max_commanded_rate,
                           params.max_commanded_angular_acceleration,
                           params.max_heading_error,
                           params.max_yaw_rate,
                           params.max_yaw_acceleration,
                           params.max_integral_velocity_error,
                           model.mass};
  const bool fine =
      usable(params.position_gain) && usable(params.velocity_gain) &&
      usable(params.attitude_gain) && usable(params.rate_gain) && usable(params.integral_gain) &&
      usable(model.inertia) && positive(params.position_gain) && positive(params.velocity_gain) &&
      positive(params.attitude_gain) && positive(params.rate_gain) &&
      (params.integral_gain.array() >= 0.0).all() && positive(model.inertia) &&
      std::all_of(std::begin(limits), std::end(limits),
                  [](double v) { return v > 0.0 && v <= kMaxInput; }) &&
      params.max_specific_thrust > kGravity && params.max_specific_thrust <= kMaxInput &&
      params.min_specific_thrust < kGravity && params.max_tilt > 0.0 &&
      params.max_tilt <= kSteepest && params.max_heading_error <= 1.5;
  if (!fine) {
    throw std::invalid_argument(
        "SE(3) controller: gains, mass and inertia must be positive, min_specific_thrust below "
        "and max_specific_thrust above 9.81 m/s^2, max_tilt in (0, 1.4] rad, "
        "max_heading_error in (0, 1.5] rad");
  }
}

/// The force [m/s^2] nearest to `desired` in this order: vertical first, so that height is kept
/// while the horizontal force has to give way to tilt and thrust limits.
Vector3d Se3Controller::limited_force(const Vector3d& desired, bool& limited) const {
  Vector3d force = desired;
  force.z() = std::clamp(force.z(), params_.min_specific_thrust, params_.max_specific_thrust);
  const double room = std::sqrt(std::max(
      0.0, params_.max_specific_thrust * params_.max_specific_thrust - force.z() * force.z()));
  const double horizontal = std::min(force.z() * std::tan(params_.max_tilt), room);
  const double asked = force.head<2>().norm();
  if (asked > horizontal) force.head<2>() *= horizontal / asked;
  limited = force != desired;
  return force;
}

/// The heading to command: never further from the vehicle's than `max_heading_error`, since
/// equation 5 loses its grip on tilt as the heading error grows, to none at 180 degrees.
Se3Controller::Heading Se3Controller::limited_heading(const Eigen::Quaterniond& q_WB,
                                                      const FlatReference& reference) const {
  // The twist about the vertical, which, unlike yaw, is defined up to upside down.
  const double heading = 2.0 * std::atan2(q_WB.z(), q_WB.w());
  const double error = wrap_angle(reference.yaw - heading);
  if (std::abs(error) > params_.max_heading_error) {
    return {heading + std::copysign(params_.max_heading_error, error), 0.0, 0.0};
  }
  return {reference.yaw,
          std::clamp(reference.yaw_rate, -params_.max_yaw_rate, params_.max_yaw_rate),
          std::clamp(reference.yaw_acceleration, -params_.max_yaw_acceleration,
                     params_.max_yaw_acceleration)};
}

double Se3Controller::limited_thrust(double specific_thrust) const {
  return model_.mass *
         std::clamp(specific_thrust, params_.min_specific_thrust, params_.max_specific_thrust);
}

TrackingOutput Se3Controller::compute(const RigidBodyState& state, const FlatReference& reference,
                                      const PositionIntegral& integral) const {
  TrackingOutput output;
  if (!usable(reference) || !usable(state.p_WB) || !usable(state.v_WB_W) || !usable(state.q_WB) ||
      !usable(state.w_WB_B)) {
    output.wrench = level(state);
    output.input_refused = true;
    return output;
  }
  const Matrix3d R = state.q_WB.normalized().toRotationMatrix();
  const Vector3d& rate = state.w_WB_B;

  // Equation 6, and the force per mass of equation 4 with the integral added.
  output.position_error = state.p_WB - reference.position;
  output.velocity_error = state.v_WB_W - reference.velocity;
  const Vector3d integral_value =
      integral.value.allFinite() ? bounded(integral.value) : Vector3d(Vector3d::Zero());
  const Vector3d integral_force = params_.integral_gain.cwiseProduct(integral_value)
                                      .cwiseMax(-params_.max_integral_acceleration)
                                      .cwiseMin(params_.max_integral_acceleration);
  const Vector3d desired = reference.acceleration + Vector3d(0.0, 0.0, kGravity) -
                           params_.position_gain.cwiseProduct(output.position_error) -
                           params_.velocity_gain.cwiseProduct(output.velocity_error) -
                           integral_force;
  const Vector3d force = limited_force(desired, output.force_limited);

  // Commanded attitude and its motion. A force that rests on a limit does not follow the jerk.
  const Heading heading = limited_heading(state.q_WB, reference);
  const bool moves = !output.force_limited;
  const FlatAttitude commanded = flat_attitude(
      force, moves ? limited_norm(bounded(reference.jerk), kMaxJerk) : Vector3d(Vector3d::Zero()),
      moves ? limited_norm(bounded(reference.snap), kMaxSnap) : Vector3d(Vector3d::Zero()),
      heading.yaw, heading.rate, heading.acceleration);
  output.q_WC = Eigen::Quaterniond(commanded.R_WC).normalized();
  const double trust = feed_forward_trust(R.col(2).dot(commanded.R_WC.col(2)));
  output.commanded_rate =
      trust * limited_norm(commanded.angular_velocity, params_.max_commanded_rate);
  const Vector3d commanded_acceleration =
      trust *
      limited_norm(commanded.angular_acceleration, params_.max_commanded_angular_acceleration);

  // Equation 5.
  const Matrix3d R_BC = R.transpose() * commanded.R_WC;
  output.attitude_error = attitude_error(R, commanded.R_WC);
  output.rate_error = rate - R_BC * output.commanded_rate;

  // Equation 4, then equation 3 with the gains inside of the inertia.
  output.wrench.thrust = limited_thrust(force.dot(R.col(2)));
  const Vector3d acceleration = -params_.attitude_gain.cwiseProduct(output.attitude_error) -
                                params_.rate_gain.cwiseProduct(output.rate_error) -
                                rate.cross(R_BC * output.commanded_rate) +
                                R_BC * commanded_acceleration;
  output.wrench.moment =
      model_.inertia.cwiseProduct(acceleration) + rate.cross(model_.inertia.cwiseProduct(rate));
  return output;
}

PositionIntegral Se3Controller::integrate(const PositionIntegral& integral,
                                          const TrackingOutput& output, double dt) const {
  const bool frozen = output.force_limited || output.input_refused || !(dt > 0.0) || dt > 1.0 ||
                      !output.position_error.allFinite() ||
                      !(output.velocity_error.norm() <= params_.max_integral_velocity_error);
  PositionIntegral next = integral;
  if (!next.value.allFinite()) next.value.setZero();
  if (!frozen) next.value += dt * output.position_error;
  for (int i = 0; i < 3; ++i) {
    const double gain = params_.integral_gain(i);
    const double limit = gain > 0.0 ? params_.max_integral_acceleration / gain : 0.0;
    next.value(i) = std::clamp(next.value(i), -limit, limit);
  }
  return next;
}

Wrench Se3Controller::level(const RigidBodyState& state, double thrust_to_weight) const {
  Wrench wrench;
  const double lift = std::isfinite(thrust_to_weight) ? thrust_to_weight * kGravity : kGravity;
  wrench.thrust = limited_thrust(lift);
  if (!usable(state.q_WB) || !usable(state.w_WB_B)) return wrench;

  const Matrix3d R = state.q_WB.normalized().toRotationMatrix();
  // The shortest turn of the body's z axis to the vertical leaves the heading alone.
  const Vector3d up = R.transpose() * Vector3d::UnitZ();
  Vector3d error = up.cross(Vector3d::UnitZ());
  // Upside down the error vanishes and every way is the same: roll.
  if (up.z() < 0.0 && error.norm() < 0.1) error = Vector3d(up.y() < 0.0 ? -0.1 : 0.1, 0.0, 0.0);
  // Tilted, more thrust holds the height; beyond the tilt limit levelling comes first.
  if (up.z() > std::cos(params_.max_tilt)) wrench.thrust = limited_thrust(lift / up.z());
  if (up.z() <= 0.0) wrench.thrust = limited_thrust(0.0);
  const Vector3d& rate = state.w_WB_B;
  wrench.moment = model_.inertia.cwiseProduct(-params_.attitude_gain.cwiseProduct(error) -
                                              params_.rate_gain.cwiseProduct(rate)) +
                  rate.cross(model_.inertia.cwiseProduct(rate));
  return wrench;
}

}  // namespace swiftlet
