// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/motion_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/conversions.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

/// Between setpoints, or truths, that are further apart nothing is interpolated [s].
constexpr double kLongestGap = 0.1;
/// As long as the flight controller listens to the guard after its last setpoint, with its usual
/// parameters [s].
constexpr double kGuardIsHeard = 0.015;

double degrees(double radians) {
  return radians * 180.0 / M_PI;
}

/// Rotation about x, then y, then z of the fixed axes, as ROS has roll, pitch and yaw [rad].
double roll_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()),
                    1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()));
}

double pitch_of(const Eigen::Quaterniond& q) {
  return std::asin(std::clamp(2.0 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0));
}

void add(Curve3& curves, double time, const Eigen::Vector3d& values) {
  for (int i = 0; i < 3; ++i) curves[static_cast<std::size_t>(i)].add(time, values[i]);
}

void add(ThinnedCurve& curve, double time, const AngleLine::Angle& angle) {
  if (angle.jumped) curve.lift();
  curve.add(time, angle.value);
}

void grow(std::optional<double>& largest, double value) {
  if (std::isfinite(value)) largest = std::max(largest.value_or(value), value);
}

PathError::OnError into(Curve3& curves) {
  return [&curves](const PathError::At& at) { add(curves, at.time, at.error); };
}

std::optional<Tracking> summed(const PathError& error) {
  const auto rms = error.rms();
  if (!rms) return std::nullopt;
  return Tracking{*rms, error.largest()};
}

}  // namespace

MotionReader::MotionReader(FlightStory& story)
    : story_(story),
      tracking_(kLongestGap, into(story.curves.error)),
      true_tracking_(kLongestGap, nullptr),
      estimation_(kLongestGap, into(story.curves.estimate_error)) {}

void MotionReader::on_odometry(double time, const nav_msgs::msg::Odometry& message,
                               const FlightPhase& phase) {
  const RigidBodyState state = from_msg(message);
  FlightCurves& curves = story_.curves;
  add(curves.estimate, time, state.p_WB);
  const auto& covariance = message.pose().covariance();
  if (covariance[0] > 0.0) {  // zeros: it is not known
    add(curves.sigma, time,
        {std::sqrt(covariance[0]), std::sqrt(covariance[7]), std::sqrt(covariance[14])});
  }
  curves.speed.add(time, state.v_WB_W.norm());
  curves.climb_rate.add(time, state.v_WB_W.z());
  curves.roll.add(time, degrees(roll_of(state.q_WB)));
  curves.pitch.add(time, degrees(pitch_of(state.q_WB)));
  add(curves.yaw, time, yaw_.next(degrees(yaw_of(state.q_WB))));
  if (!state.p_WB.allFinite()) return;

  position_ = state.p_WB;
  if (!ground_) ground_ = state.p_WB.z();
  if (phase.takeoff_point) ground_ = phase.takeoff_point->z();
  if (!phase.may_be_in_flight()) return;
  story_.map.flown.add(time, state.p_WB);
  grow(story_.figures.largest_speed, state.v_WB_W.norm());
  grow(story_.figures.largest_height, state.p_WB.z() - *ground_);
  estimation_.add_position(time, state.p_WB);
  if (!phase.landing) tracking_.add_position(time, state.p_WB);
}

void MotionReader::on_setpoint(double time, const swiftlet_msgs::msg::Setpoint& message,
                               const FlightPhase& phase) {
  const bool guard_flies = guard_heard_ && time - *guard_heard_ <= kGuardIsHeard;
  if (!guard_flies) follow(time, message, phase);
}

void MotionReader::on_guard_setpoint(double time, const swiftlet_msgs::msg::Setpoint& message,
                                     const FlightPhase& phase) {
  guard_heard_ = time;
  follow(time, message, phase);
}

void MotionReader::follow(double time, const swiftlet_msgs::msg::Setpoint& message,
                          const FlightPhase& phase) {
  FlightCurves& curves = story_.curves;
  if (message.kind() != swiftlet_msgs::msg::Setpoint_Constants::TRACK) {
    tracking_.end_reference();
    true_tracking_.end_reference();
    for (ThinnedCurve& curve : curves.setpoint) curve.lift();
    curves.setpoint_speed.lift();
    curves.setpoint_yaw.lift();
    return;
  }
  const FlatReference reference = reference_of(message);
  tracking_.add_reference(time, reference.position);
  true_tracking_.add_reference(time, reference.position);
  curves.setpoint_speed.add(time, reference.velocity.norm());
  add(curves.setpoint_yaw, time, setpoint_yaw_.next(degrees(wrap_angle(reference.yaw))));
  // That of a landing would only stretch the scale: it lies below the ground.
  if (phase.landing) {
    for (ThinnedCurve& curve : curves.setpoint) curve.lift();
    return;
  }
  add(curves.setpoint, time, reference.position);
  if (phase.may_be_in_flight()) story_.map.asked.add(time, reference.position);
}

void MotionReader::on_truth(double time, const swiftlet_msgs::msg::SimTruth& message,
                            const FlightPhase& phase) {
  const Eigen::Vector3d position = from_msg(message.pose().position());
  if (position.allFinite()) true_position_ = position;
  add(story_.curves.truth, time, position);
  estimation_.add_reference(time, position);
  if (phase.may_be_in_flight() && !phase.landing) true_tracking_.add_position(time, position);

  FlightFigures& figures = story_.figures;
  figures.contacts = message.contacts();
  figures.last_contact = message.last_contact();
  if (std::isfinite(message.minimum_clearance())) {
    figures.least_clearance = message.minimum_clearance();
  }
  if (message.contacts() > contacts_) {
    story_.events.add(time, FlightEvent::Level::kError, "contact",
                      fmt::format("touched '{}'", message.last_contact()));
    story_.map.contacts.push_back({time, position.head<2>(), message.last_contact()});
  }
  contacts_ = message.contacts();
}

void MotionReader::finish() {
  FlightFigures& figures = story_.figures;
  figures.tracking = summed(tracking_);
  figures.true_tracking = summed(true_tracking_);
  figures.estimation = summed(estimation_);
  if (!story_.map.flown.points().empty()) figures.distance = story_.map.flown.length();
}

}  // namespace swiftlet
