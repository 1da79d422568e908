// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "control/flight_loop.hpp"
#include "control/flight_reference.hpp"
#include "perception/near_obstacles.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// Watches over whoever commands the vehicle, with little logic and none of theirs: it believes
/// odometry and LIDAR, and no map, plan or mode. When a setpoint cannot be right, or there is
/// hardly room left to stop ahead of an obstacle or inside of the fence, it stops the vehicle and
/// holds it, until the commander asks for rest near by.
///
/// It says nothing of a commander or an estimator who is silent: the flight loop sees to that. It
/// says nothing of motors that are turned off, either: whether the vehicle has landed is told by
/// how the ground resists, and the commander alone knows that.
class FlightGuard {
 public:
  struct Params {
    double vehicle_radius = 0.25;  ///< of the disc that contains the vehicle [m]
    double margin = 0.03;          ///< what has to be left of the room when it has stopped [m]
    double max_speed = 8.0;        ///< of a setpoint [m/s]
    double max_gap = 1.0;          ///< of a setpoint from the vehicle [m]
    // The vehicle stops inside of it: it has to be wider than the commander's to come second.
    double fence_radius = 0.0;       ///< around the take-off point; 0 is none [m]
    double fence_height = 0.0;       ///< above it; 0 is none [m]
    double obstacles_timeout = 0.5;  ///< what was seen earlier is not believed [s]
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

  /// Of one setpoint of the commander: what the guard flies instead of it, if it does.
  std::optional<FlightSetpoint> check(const FlightSetpoint& setpoint);

  bool acting() const { return holding_.has_value(); }
  /// Why it acts, or last did; "" where it never did.
  const std::string& reason() const { return reason_; }

 private:
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
  std::optional<FlightSetpoint> last_sound_;
  std::optional<Trajectory> holding_;
  std::optional<Time> obedient_since_;
  std::string reason_;
};

}  // namespace swiftlet
