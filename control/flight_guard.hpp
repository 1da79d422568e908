// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "control/flight_loop.hpp"
#include "control/flight_reference.hpp"
#include "perception/near_obstacles.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// Watches over whoever commands the vehicle, with little logic and none of theirs: it believes
/// odometry, LIDAR and sonar, and no map, plan or mode. When a setpoint cannot be right, turns the
/// motors off in the middle of a flight, or there is hardly room left to stop ahead of an obstacle
/// or inside of the fence, it stops the vehicle and holds it, until the commander asks for rest
/// near by.
///
/// It says nothing of a commander or an estimator who is silent: the flight loop sees to that, and
/// to what a commander says who comes back after a silence.
class FlightGuard {
 public:
  struct Params {
    double vehicle_radius = 0.25;    ///< of the disc that contains the vehicle [m]
    double margin = 0.03;            ///< what has to be left of the room when it has stopped [m]
    double max_speed = 8.0;          ///< of a setpoint [m/s]
    double max_gap = 1.0;            ///< of a setpoint from the vehicle [m]
    double fence_radius = 0.0;       ///< around the take-off point; 0 is none [m]
    double fence_height = 0.0;       ///< above it; 0 is none [m]
    double obstacles_timeout = 0.5;  ///< what was seen earlier is not believed [s]
    double flying_height = 0.5;      ///< farther from the ground no motor is turned off [m]
    double release_distance = 0.20;  ///< so near to where it holds the commander may go on [m]
    double release_speed = 0.05;     ///< and so slowly he has to begin [m/s]
    double release_time = 0.3;       ///< having asked for it for so long [s]
    ReferenceLimits braking{1.0, 4.0, 40.0, 4.0, 40.0};
  };

  /// Throws std::invalid_argument where a parameter cannot be used.
  explicit FlightGuard(const Params& params);

  void set_estimate(const RigidBodyState& state) { state_ = state; }
  void set_obstacles(NearObstacles obstacles, Time time);
  void set_home(const Eigen::Vector3d& takeoff_point) { home_ = takeoff_point; }
  /// What the sonar measures [m]; infinite where it sees no ground.
  void set_range_down(double range, Time time) { range_down_ = {time, range}; }

  /// Of one setpoint of the commander: what the guard flies instead of it, if it does.
  std::optional<FlightSetpoint> check(const FlightSetpoint& setpoint);

  bool acting() const { return holding_.has_value(); }
  /// Why it acts, or last did; "" where it never did.
  const std::string& reason() const { return reason_; }

 private:
  bool is_watched(const FlightSetpoint& setpoint) const;
  std::optional<double> flying_height(Time now) const;
  std::string problem(const FlightSetpoint& setpoint) const;
  std::optional<FlightReference> brake_from_now(const FlightSetpoint& setpoint) const;
  std::string breach(const FlightSetpoint& setpoint, const FlightReference& brake) const;
  std::string collision(const FlightSetpoint& setpoint, const FlightReference& brake) const;
  void stop(const FlightSetpoint& setpoint);
  bool may_release(const FlightSetpoint& setpoint);

  Params params_;
  std::optional<RigidBodyState> state_;
  NearObstacles obstacles_;
  std::optional<Time> obstacles_seen_;
  std::optional<Eigen::Vector3d> home_;
  std::optional<std::pair<Time, double>> range_down_;
  std::optional<Time> heard_;  // the setpoint before
  std::optional<FlightSetpoint> last_sound_;
  std::optional<Trajectory> holding_;
  std::optional<Time> obedient_since_;
  std::string reason_;
};

}  // namespace swiftlet
