// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "components/report/flight_story.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// What of the flight's phase the mode tells.
struct FlightPhase {
  bool is_known = false;  ///< the recording has modes
  bool in_flight = false;
  bool landing = false;  ///< its setpoints lie below the ground, on purpose
  std::optional<Eigen::Vector3d> takeoff_point;

  bool may_be_in_flight() const { return in_flight || !is_known; }
};

/// Reads where the vehicle was, where it should have been, and where it really was.
class MotionReader {
 public:
  explicit MotionReader(FlightStory& story);

  void on_odometry(double time, const nav_msgs::msg::Odometry& message, const FlightPhase& phase);
  void on_setpoint(double time, const swiftlet_msgs::msg::Setpoint& message,
                   const FlightPhase& phase);
  /// What the guard says is flown in place of what the commander says.
  void on_guard_setpoint(double time, const swiftlet_msgs::msg::Setpoint& message,
                         const FlightPhase& phase);
  void on_truth(double time, const swiftlet_msgs::msg::SimTruth& message, const FlightPhase& phase);
  /// Writes down the figures of the whole flight.
  void finish();

  /// Where it was last: really, where the recording knows that, else as estimated.
  const std::optional<Eigen::Vector3d>& best_position() const {
    return true_position_ ? true_position_ : position_;
  }

 private:
  void follow(double time, const swiftlet_msgs::msg::Setpoint& message, const FlightPhase& phase);

  FlightStory& story_;
  PathError tracking_, true_tracking_, estimation_;
  AngleLine yaw_, setpoint_yaw_;
  std::optional<Eigen::Vector3d> position_, true_position_;
  std::optional<double> ground_;  // height of the take-off point, or of the beginning [m]
  std::optional<double> guard_heard_;
  std::uint32_t contacts_ = 0;
};

}  // namespace swiftlet
