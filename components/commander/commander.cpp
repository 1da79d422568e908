// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "components/commander/answered_commands.hpp"
#include "components/commander/attendance.hpp"
#include "components/commander/authority_desk.hpp"
#include "components/commander/director_params.hpp"
#include "components/commander/limits_message.hpp"
#include "components/commander/mission_desk.hpp"
#include "components/commander/mission_message.hpp"
#include "components/commander/request_message.hpp"
#include "components/commander/state_message.hpp"
#include "components/conversions.hpp"
#include "components/fix_message.hpp"
#include "components/manual_control_message.hpp"
#include "components/mode_message.hpp"
#include "components/planner/trajectory_message.hpp"
#include "components/setpoint_message.hpp"
#include "components/surroundings/surroundings.hpp"
#include "components/topics.hpp"
#include "control/flight_director.hpp"
#include "estimation/geodesy/local_origin.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 10ms;
constexpr int kGoalEvery = 10;     // ticks
constexpr int kStatusEvery = 10;   // ticks
constexpr int kMissionEvery = 50;  // ticks
constexpr int kClawEvery = 20;     // ticks
constexpr int kLimitsEvery = 100;  // ticks
/// What a person steers is told to a standby that often [ticks].
constexpr int kSteeredEvery = 10;
/// Missions are flown by what these do.
constexpr std::array kGuides{"flight_controller", "planner", "lidar_mapper"};

ExplorationOrder order_of(const swiftlet_msgs::msg::Exploration& message) {
  using namespace swiftlet_msgs::msg::Exploration_Constants;
  ExplorationOrder order;
  order.place = {message.viewpoint().x(), message.viewpoint().y()};
  order.reason = message.reason();
  if (message.status() == LOOK) order.kind = ExplorationOrder::Kind::kLook;
  if (message.status() == FINISHED) order.kind = ExplorationOrder::Kind::kFinished;
  return order;
}

/// Who decides what is flown: commands in, setpoints out. A standby hears the same, decides
/// nothing, and keeps the state of the one that does.
class Commander : public Component {
 public:
  explicit Commander(const ComponentContext& context)
      : Component(context),
        params_(read_director_params(parameters())),
        director_(params_),
        authority_(AuthorityDesk::read_lease(parameters())),
        desk_(runner_params(params_)),
        limits_message_(make_limits(parameters(), params_, runner_params(params_))) {
    authority_.set_dead_band(params_.steering.dead_band);
    setpoint_ = advertise(topic::setpoint);
    goal_ = advertise(topic::goal);
    status_ = advertise(topic::vehicle_status);
    ack_ = advertise(topic::mode_ack);
    state_ = advertise(topic::commander_state);
    mission_state_ = advertise(topic::mission_state);
    mission_download_ = advertise(topic::mission_download);
    mission_ = advertise(topic::commander_mission);
    claw_ = advertise(topic::claw_command);
    limits_ = advertise(topic::vehicle_limits);
    subscribe_to_vehicle();
    subscribe_to_stations();
    subscribe_to_components();
    every(kTick, [this](Time now) {
      forget(now);
      if (active()) tick(now);
    });
    set_changeable_parameters(
        {{"fence_radius", "fence_height", "low_battery", "critical_battery", "link_timeout",
          "on_fence", "on_low_battery", "on_critical_battery", "on_link_loss", "obstacle_distance",
          "stick_speed", "stick_climb_speed", "stick_turn_rate", "gps_altitude", "gps_speed",
          "landing_speed", "plan_timeout", "plan_margin", "exploration_timeout"},
         {"min_altitude", "max_altitude", "takeoff_speed", "braking_acceleration",
          "arrival_distance", "estimate_sigma_max", "heading_sigma_to_arm", "settling_to_arm",
          "min_battery_percentage", "stick_dead_band", "takeover", "vehicle_radius", "endurance",
          "control_lease"},
         [this] { return is_in_flight(); },
         [this](const Config& changed) { apply(changed); }});
  }

 private:
  void subscribe_to_vehicle() {
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      const auto& covariance = odometry.pose().covariance();
      const double variance = std::max({covariance[0], covariance[7], covariance[14]});
      director_.set_estimate(from_msg(odometry.header().stamp()), from_msg(odometry),
                             std::sqrt(variance), std::sqrt(covariance[35]));
      position_ = from_msg(odometry).p_WB;
      surroundings_.hear(odometry);
      look_around();
    });
    subscribe(
        topic::tf_static,
        [this](const tf2_msgs::msg::TFMessage& mounts) { surroundings_.hear(mounts); },
        Need::kOptional);
    subscribe(
        topic::scan,
        [this](const sensor_msgs::msg::LaserScan& scan) {
          surroundings_.hear(scan);
          look_around();
        },
        Need::kOptional);
    subscribe(topic::range_down, [this](const sensor_msgs::msg::Range& range) {
      director_.set_range_down(range.range());
    });
    subscribe(
        topic::battery,
        [this](const sensor_msgs::msg::BatteryState& battery) {
          director_.set_battery(battery.percentage());
        },
        Need::kOptional);
    subscribe(topic::motors, [this](const swiftlet_msgs::msg::MotorCommand&) {
      director_.set_motors_heard(now());
    });
    subscribe(
        topic::claw_state,
        [this](const swiftlet_msgs::msg::ClawState& claw) { desk_.hear(claw, now()); },
        Need::kOptional);
    subscribe(
        topic::gps_fix, [this](const sensor_msgs::msg::NavSatFix& fix) { hear(fix); },
        Need::kOptional);
  }

  void subscribe_to_stations() {
    subscribe(
        topic::manual_control,
        [this](const swiftlet_msgs::msg::ManualControl& sticks) {
          if (authority_.admit_sticks(sticks, now())) director_.set_sticks(from_msg(sticks), now());
        },
        Need::kOptional);
    subscribe(topic::mode, [this](const swiftlet_msgs::msg::ModeCommand& command) {
      answer(asked(command), [&]() -> Result<Acceptance> {
        if (const auto result = authority_.carry_out(command, now())) return *result;
        return carry_out(command, authority_.admit(command.station(), now()));
      });
    });
    subscribe(topic::waypoints, [this](const swiftlet_msgs::msg::Mission& mission) {
      answer(asked(mission),
             [&] { return carry_out(mission, authority_.admit(mission.station(), now())); });
    });
    subscribe(topic::mission_upload, [this](const swiftlet_msgs::msg::MissionPart& part) {
      if (active()) hear(part);
    });
    subscribe(topic::mission_fetch, [this](const swiftlet_msgs::msg::MissionFetch& fetch) {
      if (!active()) return;
      for (const auto& part : desk_.answer(fetch, now())) mission_download_.publish(part);
    });
    subscribe(topic::goal_pose, [this](const geometry_msgs::msg::PoseStamped& goal) {
      if (has_stamp(goal)) {
        answer(asked(goal), [&] { return carry_out(goal); });
      } else if (active()) {
        tell(acknowledgement(asked(goal), carry_out(goal)));
      }
    });
    subscribe(
        topic::gcs_heartbeat,
        [this](const swiftlet_msgs::msg::ComponentStatus& station) {
          const AuthorityDesk::Link link = authority_.hear(station, now());
          if (link == AuthorityDesk::Link::kHeard) director_.set_link_heard(now());
          if (link == AuthorityDesk::Link::kLeft) director_.set_link_left();
        },
        Need::kOptional);
  }

  void subscribe_to_components() {
    subscribe(topic::trajectory, [this](const swiftlet_msgs::msg::Trajectory& trajectory) {
      const bool brake = trajectory.status() == swiftlet_msgs::msg::Trajectory_Constants::BRAKE;
      last_plan_ = {from_msg(trajectory.goal_stamp()), from_msg(trajectory), brake,
                    trajectory.failure(), trajectory.reason()};
      if (active()) director_.set_plan(last_plan_);
    });
    subscribe(
        topic::exploration,
        [this](const swiftlet_msgs::msg::Exploration& exploration) {
          director_.set_exploration(order_of(exploration), now());
        },
        Need::kOptional);
    subscribe(topic::commander_mission, [this](const swiftlet_msgs::msg::MissionPart& mission) {
      if (!active()) desk_.restore(mission);
    });
    subscribe(topic::commander_state, [this](const swiftlet_msgs::msg::CommanderState& state) {
      if (!active()) restore(state);
    });
    subscribe(topic::component_status, [this](const swiftlet_msgs::msg::ComponentStatus& status) {
      attendance_.heard_status(status, now());
    });
    for (const char* guide : kGuides) {
      const std::string alive = topic::alive_name(guide);
      subscribe(Topic<swiftlet_msgs::msg::ComponentStatus>{alive.c_str(), topic::alive_qos},
                [this](const swiftlet_msgs::msg::ComponentStatus& sign) {
                  attendance_.heard_alive(sign, now());
                });
    }
    subscribe(
        topic::guard_status,
        [this](const swiftlet_msgs::msg::GuardStatus& guard) {
          director_.set_guard(guard.acting(), guard.reason(), now());
        },
        Need::kOptional);
  }

  void apply(const Config& changed) {
    const FlightDirector::Params params = read_director_params(changed);
    auto limits = make_limits(changed, params, runner_params(params));
    const Duration lease = AuthorityDesk::read_lease(changed);
    director_.set_params(params);
    desk_.set_params(runner_params(params));
    authority_.set_lease(lease);
    authority_.set_dead_band(params.steering.dead_band);
    params_ = params;
    limits_message_ = std::move(limits);
    if (active()) publish_limits(now());
  }

  static MissionRunner::Params runner_params(const FlightDirector::Params& params) {
    MissionRunner::Params runner;
    runner.gps_altitude = params.gps_altitude;
    return runner;
  }

  void look_around() {
    if (auto seen = surroundings_.take()) {
      director_.set_obstacles(std::move(seen->obstacles), seen->time);
    }
  }

  bool is_in_flight() const { return director_.state().machine.mode != Mode::kGrounded; }

  /// What a station commands, where it has control or can have it.
  template <class Command>
  Result<Acceptance> carry_out(const Command& command, const Status& admitted) {
    if (!admitted.ok()) return refused(asked(command), admitted.error());
    return carry_out(command);
  }

  /// Of an upload.
  void hear(const swiftlet_msgs::msg::MissionPart& part) {
    const Status admitted = authority_.admit(part.station(), now());
    if (admitted.ok()) {
      desk_.hear(part, director_, now());
    } else {
      desk_.refuse(part, "upload refused: " + admitted.error().reason, now());
    }
  }

  Result<Acceptance> carry_out(const swiftlet_msgs::msg::ModeCommand& command) {
    using swiftlet_msgs::msg::ModeCommand_Constants::MISSION_START;
    if (auto result = desk_.carry_out(command, director_, origin_.origin(), now())) {
      if (result->ok() && command.command() == MISSION_START) mission_id_ = desk_.id();
      return *result;
    }
    const std::optional<Request> request = request_of(command);
    if (!request) return Error{fmt::format("there is no command {}", command.command())};
    return director_.request(*request, now());
  }

  Result<Acceptance> carry_out(const swiftlet_msgs::msg::Mission& mission) {
    if (mission.checksum() != checksum(mission)) {
      return Error{"the mission's checksum is wrong: it was damaged on the way; send it again"};
    }
    Result<Acceptance> result =
        is_global(mission) ? fly_globally(mission)
                           : director_.fly(mission.checksum(), waypoints_of(mission), now());
    if (result.ok()) mission_id_ = mission.id();
    return result;
  }

  Result<Acceptance> fly_globally(const swiftlet_msgs::msg::Mission& mission) {
    const std::optional<LocalOrigin> origin = origin_.origin();
    if (!origin) {
      return Error{"gps refused: nobody says where on Earth the map is; is there a GPS fix?"};
    }
    auto waypoints = global_waypoints_of(mission, *origin, params_.gps_altitude,
                                         director_.status(now()).home.z());
    if (!waypoints.ok()) return waypoints.error();
    return director_.fly_straight(mission.checksum(), *waypoints, now());
  }

  /// Learns where the map is on Earth.
  void hear(const sensor_msgs::msg::NavSatFix& message) {
    const std::optional<GlobalFix> fix = from_msg(message);
    if (fix && position_) origin_.add(fix->position, fix->sigma, *position_);
  }

  /// A mission of one waypoint, from RViz and its like, which have no name: it counts as the word
  /// of the station that has control. Who sends it hears no acknowledgement: a refusal is in the
  /// status.
  Result<Acceptance> carry_out(const geometry_msgs::msg::PoseStamped& goal) {
    const auto waypoint = waypoint_of(goal, director_.altitude(now()));
    Result<Acceptance> result = waypoint.ok()
                                    ? director_.fly(goal_identity(goal), {*waypoint}, now())
                                    : Result<Acceptance>(waypoint.error());
    if (result.ok()) {
      mission_id_ = goal_id(goal);
    } else {
      director_.note_refusal(result.error().reason);
    }
    return result;
  }

  /// Carries a command out once, and acknowledges it each time it comes.
  template <class CarryOut>
  void answer(const swiftlet_msgs::msg::CommandAck& asked, CarryOut carry_out) {
    if (!active()) return;
    if (const auto* known = answered_.find(asked.id())) {
      ack_.publish(*known);
      return;
    }
    tell(answered_.add(acknowledgement(asked, carry_out())));
  }

  swiftlet_msgs::msg::CommandAck acknowledgement(swiftlet_msgs::msg::CommandAck ack,
                                                 const Result<Acceptance>& result) {
    ack.header(make_header(now(), frame::kMap));
    ack.accepted(result.ok());
    if (!result.ok()) {
      ack.reason(result.error().reason);
      log()->warn("{}", result.error().reason);
    }
    return ack;
  }

  void tell(const swiftlet_msgs::msg::CommandAck& ack) {
    publish_state(now());
    ack_.publish(ack);
    publish_status(now());
  }

  /// Who is not to be missed; by a standby neither.
  void forget(Time now) {
    if (!is_in_flight()) {
      attendance_.forget_who_left(now);
      director_.forget_lost_link(now);
    }
    if (authority_.link_is_of_others(now)) director_.set_link_left();
  }

  void tick(Time now) {
    check_others(now);
    tell_control(now);
    const FlightDirector::Directive directive = director_.tick(now);
    desk_.tick(director_, origin_.origin(), now);
    swiftlet_msgs::msg::Setpoint setpoint;
    setpoint.header(make_header(directive.setpoint.time, frame::kMap));
    setpoint.kind(to_msg(directive.setpoint.kind));
    set_reference(directive.setpoint.reference, setpoint);
    setpoint_.publish(setpoint);
    ++ticks_;
    if (directive.goal && (ticks_ % kGoalEvery == 0 || directive.goal->identity != last_goal_)) {
      publish_goal(*directive.goal);
    }
    if (directive.transition) log()->info("{}", describe(*directive.transition));
    publish_mission(now);
    const bool steered = director_.is_steered() && ticks_ % kSteeredEvery == 0;
    if (steered || differs(director_.state(), shared_)) publish_state(now);
    if (directive.transition || ticks_ % kStatusEvery == 0) publish_status(now);
  }

  /// Often enough while it changes, and again and again, since a ground station may be far away.
  void publish_mission(Time now) {
    if (desk_.claw_open() && ticks_ % kClawEvery == 0) {
      swiftlet_msgs::msg::ClawCommand command;
      command.header(make_header(now, frame::kMap));
      command.open(*desk_.claw_open());
      claw_.publish(command);
    }
    if (ticks_ % kLimitsEvery == 0) publish_limits(now);
    if (ticks_ % kStatusEvery != 0) return;
    const swiftlet_msgs::msg::MissionState state = desk_.state(now);
    const bool changed = differs(state, told_);
    if (state.id() != told_.id()) mission_.publish(desk_.whole(now));
    if (changed) publish_state(now);
    if (changed || ticks_ % kMissionEvery == 0) mission_state_.publish(state);
    told_ = state;
  }

  void publish_limits(Time now) {
    limits_message_.header(make_header(now, frame::kMap));
    limits_.publish(limits_message_);
  }

  void tell_control(Time now) {
    const std::string& holder = authority_.holder(now);
    if (holder == last_holder_) return;
    log()->debug("control: {}", holder.empty() ? "no station" : "station '" + holder + "'");
    last_holder_ = holder;
    publish_state(now);
    publish_status(now);
  }

  void check_others(Time now) {
    if (ticks_ % kStatusEvery == 0) director_.set_system_problem(system_problem(now));
    director_.set_guidance_problem(attendance_.failure_of_any(kGuides, now));
  }

  std::string system_problem(Time now) const {
    const std::string problem = attendance_.problem(now);
    return problem.empty() ? attendance_.absence("flight_controller", now) : problem;
  }

  void on_activated(Time) override {
    if (!restored_) return;
    log()->warn("takes over in {}", to_string(director_.state().machine.mode));
    director_.set_plan(last_plan_);  // the other one may not have come to it
  }

  void publish_state(Time now) {
    shared_ = director_.state();
    swiftlet_msgs::msg::CommanderState message = to_msg(shared_);
    message.header(make_header(now, frame::kMap));
    message.mission().id(mission_id_);
    desk_.write(message);
    authority_.write(message);
    answered_.write(message);
    state_.publish(message);
  }

  void restore(const swiftlet_msgs::msg::CommanderState& message) {
    director_.restore(from_msg(message));
    desk_.restore(message);
    authority_.restore(message);
    mission_id_ = message.mission().id();
    answered_.restore(message);
    restored_ = true;
  }

  /// Again and again while it holds, so that a planner that hears nothing knows that it is over.
  void publish_goal(const PlanGoal& goal) {
    last_goal_ = goal.identity;
    geometry_msgs::msg::PoseStamped message;
    message.header(make_header(goal.identity, frame::kMap));
    message.pose(to_pose(goal.waypoint.position, from_yaw(goal.waypoint.yaw.value_or(0.0))));
    goal_.publish(message);
  }

  void publish_status(Time now) {
    swiftlet_msgs::msg::VehicleStatus message = to_msg(director_.status(now));
    message.header(make_header(now, frame::kMap));
    message.mission_id(mission_id_);
    message.station(authority_.holder(now));
    status_.publish(message);
  }

  FlightDirector::Params params_;
  FlightDirector director_;
  FlightDirector::State shared_;  // as the standby knows it
  bool restored_ = false;
  AuthorityDesk authority_;
  std::string last_holder_;  // that was told
  MissionDesk desk_;
  swiftlet_msgs::msg::FlightLimits limits_message_;
  swiftlet_msgs::msg::MissionState told_;  // what ground stations were told last
  PlanAnswer last_plan_;
  Surroundings surroundings_;
  OriginEstimate origin_;
  std::optional<Eigen::Vector3d> position_;  // in the map
  Attendance attendance_;
  std::string mission_id_;
  AnsweredCommands answered_;
  std::int64_t ticks_ = 0;
  Time last_goal_{};
  Publisher<swiftlet_msgs::msg::Setpoint> setpoint_;
  Publisher<geometry_msgs::msg::PoseStamped> goal_;
  Publisher<swiftlet_msgs::msg::VehicleStatus> status_;
  Publisher<swiftlet_msgs::msg::CommandAck> ack_;
  Publisher<swiftlet_msgs::msg::CommanderState> state_;
  Publisher<swiftlet_msgs::msg::MissionState> mission_state_;
  Publisher<swiftlet_msgs::msg::MissionPart> mission_download_;
  Publisher<swiftlet_msgs::msg::MissionPart> mission_;
  Publisher<swiftlet_msgs::msg::ClawCommand> claw_;
  Publisher<swiftlet_msgs::msg::FlightLimits> limits_;
};

const RegisterComponent<Commander> kRegistered{"commander",
                                               "decides what is flown, from commands and plans"};

}  // namespace
}  // namespace swiftlet
