// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "control/flight_loop.hpp"
#include "control/flight_reference.hpp"
#include "control/mission.hpp"
#include "control/mode_machine.hpp"
#include "control/steering.hpp"
#include "perception/near_obstacles.hpp"
#include "planner/trajectory/piecewise_polynomial.hpp"

namespace swiftlet {

/// What the planner answered to the goal with that identity.
struct PlanAnswer {
  Time goal{};            ///< PlanGoal::identity
  Trajectory trajectory;  ///< empty where there is none
  bool brake = false;     ///< none yet: stop, and wait for the next answer
  std::string failure;    ///< in two or three words: "no path"
  std::string reason;     ///< in a sentence
};

/// Where the planner shall lead.
struct PlanGoal {
  Time identity{};           ///< when it was set; a new goal has a new one
  MissionWaypoint waypoint;  ///< with the yaw to arrive with
};

/// A cylinder around the take-off point that is not to be left; 0 is no limit.
struct Geofence {
  double radius = 0.0;  ///< [m]
  double height = 0.0;  ///< above the take-off point [m]
};

/// What the explorer says.
struct ExplorationOrder {
  enum class Kind { kLook, kFinished, kStuck };
  Kind kind = Kind::kStuck;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of kLook: fly there [m]
  std::string reason;                               ///< of kStuck
};

/// Turns requests, missions and plans into one setpoint a tick: the mode machine decides what is
/// flown, this class how. Pure: time and everything else is passed in.
///
/// Take-off and landing are vertical moves with bounded jerk, Hover brakes and holds, Manual and
/// Assisted Manual follow the sticks, GPS Guidance flies straight lines, Indoor Navigation follows
/// the planner's trajectories. A mission goes from waypoint to waypoint and
/// rests at each; a goal is set at rest only, so that planner and director agree where it begins. A
/// trajectory that begins neither on the reference that is flown nor at the vehicle is refused,
/// and the vehicle stops. When there is no plan in time, the mission ends in Hover, and the reason
/// names the waypoint.
///
/// A landing sinks until the vehicle resists: its height stays above the reference although the
/// reference goes below the ground. Sonar or height alone do not tell the ground from 3 cm above.
/// While the estimate is lost the sonar has to do; when it comes back, the landing goes on from
/// where the vehicle is.
class FlightDirector {
 public:
  struct Params {
    ModeMachine::Params modes;
    ReferenceLimits takeoff{0.8, 1.0, 5.0, 2.0, 10.0};
    ReferenceLimits landing{0.4, 0.8, 5.0, 2.0, 10.0};
    ReferenceLimits braking{1.0, 2.0, 15.0, 2.0, 10.0};
    double landing_depth = 0.4;        ///< a landing aims so far below the take-off point [m]
    double landing_resistance = 0.10;  ///< landed is so far above the landing's reference [m]
    double ground_range = 0.18;        ///< the downward sonar reads less on the ground [m]
    double ground_height = 0.25;       ///< and the estimate says less above the take-off point [m]
    double plan_gap = 0.10;            ///< farther off what is flown no plan may begin [m]
    double arrival_distance = 0.15;    ///< nearer to the waypoint counts as there [m]
    double arrival_speed = 0.20;       ///< [m/s]
    double arrival_timeout = 3.0;      ///< after the trajectory's end, then it counts as missed [s]
    double plan_timeout = 2.0;         ///< an unanswered goal fails after, at rest [s]
    /// An estimate older than this is lost. A standby estimator takes over before, and the flight
    /// controller bridges the gap with its IMU [s].
    double estimate_timeout = 0.25;
    /// An exploration whose explorer is silent, stuck or insists on a place that was flown to, or
    /// to which there is no plan, ends after [s].
    double exploration_timeout = 5.0;
    double estimate_sigma_max = 0.30;    ///< of the position, any axis [m]
    double heading_sigma_to_arm = 0.02;  ///< better known before take-off [rad]
    /// Unbroken estimate before take-off: what is learnt of the sensors in that time is what
    /// carries the vehicle down when the estimator dies during the climb [s].
    double settling_to_arm = 8.0;
    double min_battery_percentage = 0.30;  ///< to take off [0..1]

    SteeringLimits steering;
    double takeover = 0.25;        ///< a stick this far from its centre takes over from any mode
    double sticks_period = 0.15;   ///< sticks not heard for so long count as released [s]
    double sticks_timeout = 0.5;   ///< and for so long as gone [s]
    double vehicle_radius = 0.25;  ///< of the disc that contains the vehicle [m]
    double obstacle_distance = 0.305;  ///< from there on sticks are stopped: 1 ft in seed 004 [m]
    double obstacles_timeout = 0.5;    ///< what was seen earlier is not seen any more [s]
    double lowest_range = 0.40;        ///< of the sonar, to which sticks descend [m]

    double gps_altitude = 15.24;  ///< above the take-off point: 50 ft in seed 004 [m]
    ReferenceLimits cruise{3.0, 1.5, 6.0, 2.0, 10.0};  ///< of GPS Guidance

    using Demand = Situation::Demand;
    Geofence fence;
    Demand on_fence = Demand::kReturn;  ///< when the fence is left
    double low_battery = 0.20;          ///< [0..1]
    Demand on_low_battery = Demand::kReturn;
    double critical_battery = 0.10;  ///< [0..1]
    Demand on_critical_battery = Demand::kLand;
    double link_timeout = 5.0;  ///< of a ground station that was there [s]
    Demand on_link_loss = Demand::kReturn;
  };

  struct Status {
    Mode mode = Mode::kGrounded;
    bool armed = false;
    bool ready = false;
    std::string reason;  ///< of the last change or noted refusal, or why not ready
    double height = 0.0;
    std::size_t waypoint = 0;  ///< flown to, from 1; 0 without a mission
    std::size_t waypoint_count = 0;
    std::size_t number = 0;  ///< of that waypoint, as reasons name it
    bool mission_done = false;
    Eigen::Vector3d home = Eigen::Vector3d::Zero();  ///< the take-off point [m]
  };

  struct Directive {
    FlightSetpoint setpoint;
    std::optional<PlanGoal> goal;          ///< while it is guided by plans
    std::optional<Transition> transition;  ///< what happened in this tick
  };

  /// All that it flies and has decided; what it senses is not in it. Another director that is given
  /// this goes on where this one was.
  struct State {
    ModeMachine::State machine;
    Eigen::Vector3d takeoff_point = Eigen::Vector3d::Zero();
    Trajectory simple;                 ///< flown where there is no plan
    std::optional<Trajectory> active;  ///< plan that is flown
    std::deque<Trajectory> coming;     ///< plans that begin later
    bool blind = false;                ///< in Land: level, without a reference
    std::vector<MissionWaypoint> waypoints;
    std::size_t waypoint = 0;           ///< index of the one flown to
    std::size_t first_number = 1;       ///< of the first waypoint, as reasons name it
    std::optional<PlanGoal> goal;       ///< none while the vehicle stops first
    std::optional<Time> waiting_since;  ///< for the planner's answer
    std::string refusal;                ///< of the last plan, where it was refused
    bool mission_done = false;
    double cruise_altitude = 0.0;  ///< of an exploration, in the map [m]
    std::uint32_t demanded = 0;    ///< policies that have had their say, a bit each
    Situation::Navigation navigation = Situation::Navigation::kInactive;
    std::string navigation_problem;
    std::string last_reason;
  };

  /// Throws std::invalid_argument where a parameter cannot be used.
  explicit FlightDirector(const Params& params);
  /// From now on; what is flown already stays as it is. Throws std::invalid_argument, with nothing
  /// changed.
  void set_params(const Params& params);

  /// Sigmas are those of the worst axis of the position [m] and of the heading [rad].
  void set_estimate(Time time, const RigidBodyState& state, double position_sigma,
                    double heading_sigma);
  /// What is no number is ignored. No echo is an infinite range.
  void set_range_down(double range);
  /// What is no number is a battery that is not measured; it does not keep from flying.
  void set_battery(double percentage);
  /// Heard at `time`; what is no number is ignored.
  void set_sticks(const Sticks& sticks, Time time);
  /// What was seen around at `time`.
  void set_obstacles(NearObstacles obstacles, Time time);
  /// That a ground station is there, heard at `time`. One that was never there is not missed.
  void set_link_heard(Time time) { link_heard_ = time; }
  /// It said that it leaves: it is not missed.
  void set_link_left() { link_heard_.reset(); }
  /// Who fell silent before a flight is not missed in it: to be called on the ground.
  void forget_lost_link(Time now);
  /// What the guard says, heard at `time`: whether it flies instead of us, and why.
  void set_guard(bool acting, const std::string& reason, Time time);
  /// That the flight controller is alive, heard at `time`.
  void set_motors_heard(Time time) { motors_heard_ = time; }

  /// Carries out a request, or says why not. `now` is that of the coming tick.
  Result<Acceptance> request(const Request& request, Time now);
  /// Checks the mission and begins to fly it. `id` is the same for the same waypoints.
  /// Reasons count waypoints from `first_number` on.
  Result<Acceptance> fly(std::uint64_t id, const std::vector<MissionWaypoint>& waypoints, Time now,
                         std::size_t first_number = 1);
  /// The same in straight lines, each leg at the height of its end (GPS Guidance).
  Result<Acceptance> fly_straight(std::uint64_t id, const std::vector<MissionWaypoint>& waypoints,
                                  Time now, std::size_t first_number = 1);
  /// Why a place cannot be flown to indoors; "" where it can.
  std::string waypoint_problem(const MissionWaypoint& waypoint) const;
  void set_plan(const PlanAnswer& answer);
  /// Where to fly in Indoor Exploration; heard at `now`.
  void set_exploration(const ExplorationOrder& order, Time now);
  /// Puts into the status why something was refused, for who gets no answer.
  void note_refusal(const std::string& reason) { flying_.last_reason = reason; }

  /// What is wrong elsewhere on board: it keeps from arming. "" where nothing is.
  void set_system_problem(const std::string& problem) { system_problem_ = problem; }
  /// Why missions cannot be flown (any longer): those who plan or map fell silent. "" where they
  /// can.
  void set_guidance_problem(const std::string& problem);

  Directive tick(Time now);
  Status status(Time now) const;
  /// Of the reference that is flown, above the origin of the map [m].
  double altitude(Time now) const { return reference(now).position.z(); }

  /// A person steers it: Manual or Assisted Manual.
  bool is_steered() const;

  State state() const;
  void restore(const State& state);

 private:
  Situation situation(Time now) const;
  std::string not_ready_reason(Time now) const;
  std::string estimate_problem(Time now) const;
  bool sonar_near_ground() const;
  bool low() const;
  bool landed(Time now) const;

  void enter(Mode mode, Time now);
  FlatReference reference(Time now) const;
  FlatReference at_vehicle() const;
  void stop(const FlatReference& from, Time now);
  void sink(Time now);

  void heed_sticks(Time now);
  void follow_sticks(Time now);
  std::string sticks_problem(Time now) const;
  std::string obstacles_problem(Time now) const;
  Steering allowed(Steering wanted, Time now) const;
  bool stays_clear(const Trajectory& candidate) const;

  void follow_legs(Time now);
  void heed_policies(Time now, Situation& situation);
  void heed_guard(Time now, Situation& situation);
  double way_to_fence(const Eigen::Vector2d& place, const Eigen::Vector2d& direction) const;
  std::string fence_problem(const Eigen::Vector3d& place, double slack = 0.0) const;
  std::string plan_leaves_fence(const Trajectory& plan) const;
  std::string place_problem(const MissionWaypoint& waypoint, double highest) const;
  std::string mission_problem(const std::vector<MissionWaypoint>& waypoints,
                              std::size_t first_number, double highest) const;
  Result<Acceptance> begin(const Request& request, const std::vector<MissionWaypoint>& waypoints,
                           Time now, std::size_t first_number);
  Result<Acceptance> go_back(Time now);

  bool is_guided() const;
  void follow_mission(Time now);
  Result<Acceptance> explore(Time now);
  void follow_exploration(Time now);
  bool follow_plans(Time now);
  void set_goal(const MissionWaypoint& waypoint, Time now);
  std::string goal_name() const;
  void take_answer(const PlanAnswer& answer, Time now);
  std::string plan_problem(const Trajectory& plan, Time now) const;
  double standstill(Time now);
  bool arrived(const Eigen::Vector3d& place) const;
  void next_waypoint();
  void fail_navigation(const std::string& problem);

  Params params_;
  ModeMachine machine_;

  RigidBodyState state_;
  std::optional<Time> estimate_time_;
  Time estimate_since_{};  // without a gap
  double position_sigma_ = 0.0;
  double heading_sigma_ = 0.0;
  std::optional<double> range_down_;
  std::optional<double> battery_percentage_;
  std::optional<Time> motors_heard_;
  Sticks sticks_;
  std::optional<Time> sticks_heard_;
  NearObstacles obstacles_;
  std::optional<Time> obstacles_seen_;
  std::optional<Time> link_heard_;
  bool guard_acting_ = false;
  bool must_release_ = false;  // the sticks, before they are heeded again
  std::string guard_reason_;
  std::optional<Time> guard_heard_;  // forgotten once its silence was told
  std::string system_problem_;
  std::string guidance_problem_;

  State flying_;
  std::deque<PlanAnswer> answers_;           // to its goal, since the last tick
  std::optional<ExplorationOrder> order_;    // since exploration began, or was taken over
  std::optional<Time> order_heard_;          // that, or the beginning
  std::optional<Time> idle_since_;           // in exploration, with nothing to fly
  std::optional<Eigen::Vector3d> still_at_;  // in a mission, since `still_since_`
  Time still_since_{};
};

}  // namespace swiftlet
