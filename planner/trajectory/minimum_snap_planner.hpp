// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "planner/trajectory/limits.hpp"
#include "planner/trajectory/minimum_snap.hpp"

namespace swiftlet {

/// How the time is shared out between the pieces.
enum class Timing {
  kFast,       ///< so that the pieces come near the limits together, for a short flight
  kLeastSnap,  ///< so that the snap cost is least for the duration of the whole
};

/// Chooses the times so that limits hold.
class MinimumSnapPlanner {
 public:
  struct Params {
    TrajectoryLimits limits;
    Timing timing = Timing::kFast;
    /// Yaw is given time for this rate [rad/s], or for the limit where that is less.
    double nominal_yaw_rate = 1.0;
    /// Share of the limits that times are chosen to leave free, for a later trajectory that starts
    /// on this one in flight. It may be used up by such a start, the limits are never exceeded.
    double reserve = 0.1;
    double min_duration_s = 0.1;  ///< of a piece
    int balance_rounds = 6;       ///< of moving time between pieces
    int max_iterations = 60;      ///< of stretching all of them
  };

  MinimumSnapPlanner();
  explicit MinimumSnapPlanner(const Params& params);

  /// Minimum-snap trajectory through the waypoints that keeps the limits at every moment. Times
  /// start from a trapezoidal speed profile that slows down in turns, are shifted to the pieces
  /// that need them most (or to those that lower the cost most), and are stretched together until
  /// no limit is broken. From rest to rest that always ends.
  ///
  /// The derivatives of the start are kept as they are. Where stretching does not help, since
  /// longer pieces only give the acceleration of the start more time to act, a short first piece
  /// ends acceleration and jerk, and the minimum starts from there (continuous up to the jerk).
  /// Fails when the start itself breaks a limit or nothing of this helps.
  Result<Trajectory> plan(Time start_time, const FlatReference& start,
                          const std::vector<Waypoint>& waypoints) const;

  /// The trajectory of least snap that takes `duration_s`. Fails where it breaks a limit, and says
  /// which and how long it would have to take; nothing is stretched and nothing kept in reserve.
  Result<Trajectory> plan_for(Time start_time, const FlatReference& start,
                              const std::vector<Waypoint>& waypoints, double duration_s) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
};

}  // namespace swiftlet
