// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <utility>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/planner/limits_config.hpp"
#include "components/planner/trajectory_message.hpp"
#include "components/runtime/supervision/staleness.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/so3.hpp"
#include "planner/path/replanner.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kGoalPeriod = 100ms;  // of the commander
constexpr Duration kTick = 50ms;
constexpr Duration kAlivePeriod = 100ms;  // no plan takes longer
constexpr Duration kCorruptMapTimeout = 500ms;
/// A setpoint is so far from a trajectory that is flown at most: it is a little older [m].
constexpr double kFlownGap = 0.1;
constexpr double kLargestClearance = 10.0;  // [m]

namespace answers = swiftlet_msgs::msg::Trajectory_Constants;

/// A failure in a few words, which "to waypoint 2" can follow.
const char* phrase(PlanFailure failure) {
  switch (failure) {
    case PlanFailure::kNone:
      return "no failure";
    case PlanFailure::kBadInput:
      return "no usable map or goal for the way";
    case PlanFailure::kStartInContact:
      return "no way out of contact";
    case PlanFailure::kGoalInObstacle:
      return "no room at the goal on the way";
    case PlanFailure::kGoalOutsideMap:
      return "no map on the way";
    case PlanFailure::kNoPath:
      return "no path";
    case PlanFailure::kNoTrajectory:
      return "no trajectory within the limits";
  }
  return "no plan";
}

Replanner::Params read_params(const Config& config) {
  Replanner::Params params;
  params.trajectory.yaw = YawPolicy::kGoal;
  PathCost& cost = params.trajectory.path.cost;
  config.read("radius", cost.radius, {0.001, kLargestClearance});
  config.read("margin", cost.margin, {0.0, kLargestClearance});
  config.read("preferred_clearance", cost.preferred_clearance, {0.001, kLargestClearance});
  config.read("clearance_weight", cost.clearance_weight, kNotNegative);
  config.read("unknown_weight", cost.unknown_weight, kNotNegative);
  config.read("unknown_is_free", cost.unknown_is_free);
  config.read("samples", params.trajectory.path.samples, {10, 100000});
  read_limits(config, params.trajectory.minimum_snap.limits);
  config.read("improvement", params.improvement, {0.0, 1.0});
  int seed = static_cast<int>(params.seed);
  config.read("seed", seed, {0, 2e9});
  params.seed = static_cast<std::uint32_t>(seed);
  return params;
}

/// A trajectory to the goal through the map, planned anew at 5 Hz and when the map blocks it. A
/// standby keeps what the active planner answered last, and goes on from there.
class Planner : public Component {
 public:
  explicit Planner(const ComponentContext& context)
      : Component(context), replanner_(read_params(parameters())), goal_watch_(kGoalPeriod) {
    set_alive_period(kAlivePeriod);
    trajectory_ = advertise(topic::trajectory);
    path_ = advertise(topic::path);
    subscribe(topic::odometry,
              [this](const nav_msgs::msg::Odometry& odometry) { vehicle_ = from_msg(odometry); });
    subscribe(topic::setpoint, [this](const swiftlet_msgs::msg::Setpoint& setpoint) {
      reference_ = reference_of(setpoint);
    });
    subscribe(topic::goal, [this](const geometry_msgs::msg::PoseStamped& goal) { on_goal(goal); });
    subscribe(topic::map, [this](const nav_msgs::msg::OccupancyGrid& map) { hear(map); });
    subscribe(topic::trajectory, [this](const swiftlet_msgs::msg::Trajectory& answer) {
      if (!active()) adopt(answer);
    });
    every(kTick, [this](Time) { plan(); });
    set_changeable_parameters(
        {{"max_speed", "max_acceleration", "margin", "preferred_clearance", "clearance_weight",
          "unknown_weight", "unknown_is_free", "samples", "improvement"},
         {},
         nullptr,
         [this](const Config& changed) { replanner_.set_params(read_params(changed)); }});
  }

 private:
  void on_goal(const geometry_msgs::msg::PoseStamped& message) {
    goal_watch_.heard(now());
    const Time identity = from_msg(message.header().stamp());
    goal_.position = from_msg(message.pose().position());
    goal_.yaw = yaw_of(from_msg(message.pose().orientation()));
    if (goal_identity_ == identity) return;
    goal_identity_ = identity;
    answered_ = false;
    finished_ = false;
    braking_ = false;
    replanner_.reset();
    // What is flown to another goal goes on until there is a plan to this one.
    if (reference_at_rest()) {
      current_ = resting_at(reference_, now());
    } else if (!is_flown(current_)) {
      current_ = {};
      braking_ = true;
    }
    plan();
  }

  /// A map that is none is not taken for one without obstacles: the last good one counts, and who
  /// relies on plans hears of it when no better one comes.
  void hear(const nav_msgs::msg::OccupancyGrid& map) {
    OccupancyGrid grid = from_msg(map, OccupancyGrid::Params());
    if (grid.empty()) {
      if (!corrupt_since_) {
        corrupt_since_ = now();
        log()->warn("a map was refused: {} x {} cells of {} m, {} of them given",
                    map.info().width(), map.info().height(), map.info().resolution(),
                    map.data().size());
      }
      return;
    }
    corrupt_since_.reset();
    grid_ = std::move(grid);
    plan();
  }

  std::string obstacle() const override {
    const bool lasts = corrupt_since_ && now() - *corrupt_since_ > kCorruptMapTimeout;
    return lasts ? "map: what comes on it is no map" : "";
  }

  bool reference_at_rest() const {
    return reference_.velocity.isZero(0.0) && reference_.acceleration.isZero(0.0);
  }
  bool is_flown(const Trajectory& trajectory) const {
    return !trajectory.empty() &&
           (trajectory.evaluate(now()).position - reference_.position).norm() < kFlownGap;
  }

  /// What the active planner answered.
  void adopt(const swiftlet_msgs::msg::Trajectory& answer) {
    goal_identity_ = from_msg(answer.goal_stamp());
    current_ = from_msg(answer);
    answered_ = !current_.empty();
    braking_ = answer.status() == answers::BRAKE;
    finished_ = answer.status() == answers::FAILED;
  }

  void plan() {
    if (!active()) return;
    if (goal_watch_.stale(now())) {
      goal_identity_.reset();
      current_ = {};
      return;
    }
    if (!goal_identity_ || finished_) return;
    if (braking_) {
      if (!reference_at_rest()) return;
      braking_ = false;
      current_ = resting_at(reference_, now());
    }
    Replanner::Input input;
    input.now = now();
    input.current = &current_;
    input.grid = &grid_;
    input.vehicle = vehicle_;
    input.goal = goal_;
    const ReplanDecision decision = replanner_.step(input);
    switch (decision.action) {
      case ReplanAction::kKeep:
        // A goal where the vehicle is, or is going, is answered with what is flown.
        if (!answered_ && Replanner::leads_to(goal_, current_)) follow();
        break;
      case ReplanAction::kFollow:
        current_ = decision.trajectory;
        follow();
        publish_path(decision.path);
        break;
      case ReplanAction::kBrake:
        answer(answers::BRAKE, decision);
        braking_ = true;
        break;
      case ReplanAction::kFail:
        answer(answers::FAILED, decision);
        finished_ = true;
        break;
    }
  }

  void follow() {
    trajectory_.publish(to_msg(current_, *goal_identity_));
    answered_ = true;
  }

  void answer(std::uint8_t status, const ReplanDecision& decision) {
    log()->warn("{}: {}", phrase(decision.failure), decision.reason);
    trajectory_.publish(no_trajectory_msg(now(), *goal_identity_, status, phrase(decision.failure),
                                          decision.reason));
    current_ = {};
  }

  void publish_path(const Path& path) {
    nav_msgs::msg::Path message;
    message.header(make_header(now(), frame::kMap));
    for (const Eigen::Vector2d& point : path.points) {
      geometry_msgs::msg::PoseStamped pose;
      pose.header(message.header());
      pose.pose(
          to_pose({point.x(), point.y(), goal_.position.z()}, Eigen::Quaterniond::Identity()));
      message.poses().push_back(pose);
    }
    path_.publish(message);
  }

  Replanner replanner_;
  StalenessWatch goal_watch_;
  std::optional<Time> goal_identity_;
  FlightGoal goal_;
  bool answered_ = false;  // with a trajectory
  bool finished_ = false;
  bool braking_ = false;
  Trajectory current_;
  OccupancyGrid grid_;
  std::optional<Time> corrupt_since_;  // no good map came after
  RigidBodyState vehicle_;
  FlatReference reference_;
  Publisher<swiftlet_msgs::msg::Trajectory> trajectory_;
  Publisher<nav_msgs::msg::Path> path_;
};

const RegisterComponent<Planner> kRegistered{"planner", "a trajectory to the goal through the map"};

}  // namespace
}  // namespace swiftlet
