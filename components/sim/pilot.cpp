// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/pilot.hpp"

#include <fmt/format.h>

#include "components/commander/mission_message.hpp"
#include "components/conversions.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;
namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

constexpr Duration kTick = 50ms;
constexpr char kStation[] = "pilot";
constexpr Duration kResend = 500ms;
/// A command that is not acknowledged within so long has failed.
constexpr Duration kAckTimeout = 5s;
/// After the rotors stopped, until the vehicle rests.
constexpr Duration kSettle = 1s;
/// A commander whose status does not come any more for so long is not there.
constexpr Duration kStatusTimeout = 1s;
/// After something went wrong, until the run ends: what becomes of the vehicle belongs to the run.
constexpr Duration kAftermath = 8s;
/// How long the vehicle may take to become ready before it is armed.
constexpr Duration kReadyTimeout = 30s;

Scenario scenario_of(const Config& parameters) {
  std::string file;
  parameters.require("scenario", file);
  return Scenario::load(file);
}

std::vector<MissionWaypoint> waypoints_of(const Scenario& scenario) {
  std::vector<MissionWaypoint> waypoints;
  const double altitude = scenario.mission.takeoff_altitude;
  for (const Scenario::Waypoint& waypoint : scenario.mission.waypoints) {
    waypoints.push_back({{waypoint.x, waypoint.y, waypoint.z.value_or(altitude)}, waypoint.yaw});
  }
  if (scenario.mission.return_to_pad) {
    waypoints.push_back({{scenario.start.x, scenario.start.y, altitude}, std::nullopt});
  }
  return waypoints;
}

}  // namespace

Pilot::Pilot(const ComponentContext& context) : Pilot(context, scenario_of(context.parameters)) {}

Pilot::Pilot(const ComponentContext& context, const Scenario& scenario)
    : Component(context), scenario_(scenario) {
  mode_ = advertise(topic::mode);
  waypoints_ = advertise(topic::waypoints);
  subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& status) {
    status_ = status;
    status_heard_ = now();
  });
  subscribe(topic::mode_ack, [this](const swiftlet_msgs::msg::CommandAck& ack) { on_ack(ack); });
  every(kTick, [this](Time now) { advance(now); });
}

void Pilot::on_ack(const swiftlet_msgs::msg::CommandAck& ack) {
  if (ack.id() != command_id() || failed_at_) return;
  if (!ack.accepted()) {
    finish(false, ack.reason());
  } else {
    acknowledged_ = true;
  }
}

void Pilot::advance(Time now) {
  if (step_ == Step::kDone) return;
  if (failed_at_) {
    if (now - *failed_at_ > kAftermath) end();
    return;
  }
  if (!started_) {
    started_ = true;
    begun_ = now;
  }
  if (step_ == Step::kArm && !(status_heard_ && status_.ready())) {
    if (now - begun_ > kReadyTimeout) {
      finish(false,
             status_heard_ ? status_.reason() : "no vehicle/status; is a commander running?");
    }
    return;
  }
  if (step_ != Step::kArm && to_seconds(now - armed_at_) > scenario_.time_limit_s) {
    finish(false, fmt::format("time limit of {} s exceeded during {}", scenario_.time_limit_s,
                              step_name()));
    return;
  }
  if (step_ != Step::kArm && now - *status_heard_ > kStatusTimeout) {
    finish(false, fmt::format("nothing on vehicle/status for {:.1f} s during {}: the commander is "
                              "silent",
                              to_seconds(now - *status_heard_), step_name()));
    return;
  }
  if (!acknowledged_) {
    if (now - begun_ > kAckTimeout + kReadyTimeout) {
      finish(false, fmt::format("{} was not acknowledged", step_name()));
    } else if (now - sent_ >= kResend || sent_ == Time{}) {
      send(now);
    }
    return;
  }

  switch (step_) {
    case Step::kArm:
      armed_at_ = now;
      begin(Step::kTakeoff);
      break;
    case Step::kTakeoff:
      if (status_.mode() == mode::HOVER) {
        const bool flies = scenario_.mission.explore || !scenario_.mission.waypoints.empty();
        begin(flies ? Step::kMission : Step::kLand);
      } else if (status_.mode() != mode::TAKEOFF) {
        finish(false, status_.reason());
      }
      break;
    case Step::kMission:
      if (status_.mode() == mode::INDOOR_NAVIGATION) break;
      if (status_.mode() == mode::INDOOR_EXPLORATION) break;
      if (!status_.mission_done()) {
        finish(false, status_.reason());
      } else if (scenario_.mission.land) {
        begin(Step::kLand);
      } else {
        finish(true, "mission flown");
      }
      break;
    case Step::kLand:
      if (status_.mode() == mode::GROUNDED && !status_.armed()) {
        if (!landed_at_) landed_at_ = now;
        if (now - *landed_at_ > kSettle) finish(true, "mission flown and landed");
      } else if (status_.mode() != mode::LAND) {
        finish(false, status_.reason());
      }
      break;
    case Step::kDone:
      break;
  }
}

void Pilot::begin(Step step) {
  step_ = step;
  acknowledged_ = false;
  begun_ = now();
  send(now());
}

void Pilot::send(Time now) {
  sent_ = now;
  if (step_ == Step::kMission && !scenario_.mission.explore) {
    auto mission = make_mission(now, command_id(), waypoints_of(scenario_));
    mission.station(kStation);
    waypoints_.publish(mission);
    return;
  }
  swiftlet_msgs::msg::ModeCommand message;
  message.header(make_header(now, frame::kMap));
  message.id(command_id());
  message.command(step_ == Step::kArm       ? command::ARM
                  : step_ == Step::kTakeoff ? command::TAKEOFF
                  : step_ == Step::kMission ? command::EXPLORE
                                            : command::LAND);
  message.altitude(scenario_.mission.takeoff_altitude);
  message.station(kStation);
  mode_.publish(message);
}

void Pilot::finish(bool success, const std::string& reason) {
  outcome_.finished = true;
  outcome_.success = success;
  outcome_.reason = reason;
  outcome_.flight_time = armed_at_ == Time{} ? 0.0 : to_seconds(now() - armed_at_);
  if (success) {
    log()->info("{}", reason);
    end();
  } else {
    log()->error("{}", reason);
    failed_at_ = now();
    if (armed_at_ == Time{}) end();  // it never left the ground
  }
}

void Pilot::end() {
  step_ = Step::kDone;
  stop(outcome_.success ? 0 : 1);
}

std::string Pilot::command_id() const {
  return fmt::format("pilot-{}-{}", scenario_.name, step_name());
}

const char* Pilot::step_name() const {
  switch (step_) {
    case Step::kArm:
      return "arm";
    case Step::kTakeoff:
      return "takeoff";
    case Step::kMission:
      return "mission";
    case Step::kLand:
      return "land";
    case Step::kDone:
      return "done";
  }
  return "unknown";
}

namespace {
const RegisterComponent<Pilot> kRegistered{"pilot", "flies the mission of a scenario by commands"};
}  // namespace

}  // namespace swiftlet
