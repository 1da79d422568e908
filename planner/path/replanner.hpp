// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "planner/path/trajectory_planner.hpp"

namespace swiftlet {

enum class ReplanAction {
  kKeep,    ///< go on with what is flown
  kFollow,  ///< switch to the new trajectory, which starts at its start time
  kBrake,   ///< stop now, then step on without a trajectory: there is no evading in flight
  kFail,    ///< give up, stop and hover: the reason says why
};

struct ReplanDecision {
  ReplanAction action = ReplanAction::kKeep;
  Trajectory trajectory;  ///< of kFollow
  Path path;              ///< of kFollow
  PlanFailure failure = PlanFailure::kNone;
  std::string reason;    ///< of kBrake, kFail, and of a kKeep that could not plan
  bool blocked = false;  ///< the map blocks the trajectory that is flown
};

/// When to plan anew: at a rate, at once when the map blocks what is flown, and never for ever.
///
/// New trajectories start on the current one, a lead time ahead, with its position, velocity,
/// acceleration and jerk, so that the reference has no step. What is flown is kept unless it is
/// blocked or the new one is clearly cheaper. While there is none to fly, or the one flown is
/// blocked, a failed planning is repeated at the rate until `give_up_after`, and ends in kFail.
/// When the obstacle is nearer than it takes to brake, the answer is kBrake at once, at most
/// `max_brakes` times a goal.
class Replanner {
 public:
  struct Params {
    TrajectoryPlanner::Params trajectory;
    Duration period = std::chrono::milliseconds(200);
    Duration lead = std::chrono::milliseconds(60);  ///< switch over so far ahead
    Duration give_up_after = std::chrono::milliseconds(800);
    double improvement = 0.03;        ///< cheaper by this share of the rest to be worth a change
    double brake_reserve_s = 0.3;     ///< on top of the time that braking takes
    double tracking_error_max = 0.5;  ///< farther off the reference, plan from the vehicle [m]
    double blocked_tolerance = 0.03;  ///< nearer than allowed by so much is not blocked: noise [m]
    int max_brakes = 5;
    std::uint32_t seed = 1;
  };

  struct Input {
    Time now{};
    /// What is flown now, null or empty for nothing. One that has ended is hovering at its end.
    const Trajectory* current = nullptr;
    const OccupancyGrid* grid = nullptr;
    RigidBodyState vehicle;
    FlightGoal goal;
  };

  Replanner();
  explicit Replanner(const Params& params);

  /// To be called at least once a period, better with every new map. Forgets its past when the goal
  /// changes.
  ReplanDecision step(const Input& input);
  /// From the next step on, which plans at once, and whose plan replaces what is flown. Throws what
  /// the constructor throws, with nothing changed.
  void set_params(const Params& params);
  /// Forgets everything: the next step plans at once.
  void reset();

  /// Whether a trajectory ends at the goal: then it is kept, and there may never be another.
  static bool leads_to(const FlightGoal& goal, const Trajectory& trajectory);

  const Params& params() const { return params_; }

 private:
  struct Situation;  // what is known before planning
  Situation assess(const Input& input);
  ReplanDecision answer_failure(const Input& input, const Situation& situation, PlanFailure failure,
                                const std::string& reason);

  Params params_;
  TrajectoryPlanner planner_;
  ClearanceMap map_;  // empty where there is none
  std::optional<FlightGoal> goal_;
  std::optional<Time> last_plan_;
  bool replaces_ = false;  // what is flown, however good it is
  std::optional<Time> failing_since_;
  PlanFailure last_failure_ = PlanFailure::kNone;
  std::string last_reason_;
  int brakes_ = 0;
};

}  // namespace swiftlet
