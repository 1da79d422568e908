// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "mode_flight.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "components/manual_control_message.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
namespace command_code = swiftlet_msgs::msg::ModeCommand_Constants;

constexpr Duration kPeriod = 50ms;

HostOptions lockstep(std::vector<Fault> faults) {
  HostOptions options;
  options.lockstep = true;
  options.participant.domain = 76;
  options.faults = std::move(faults);
  return options;
}

}  // namespace

ScriptedPilot::ScriptedPilot(const ComponentContext& context) : Component(context) {
  mode_ = advertise(topic::mode);
  waypoints_ = advertise(topic::waypoints);
  sticks_ = advertise(topic::manual_control);
  map_ = advertise(topic::map);
  subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& now) {
    if (now.mode() != status.mode() || now.reason() != status.reason()) {
      log.push_back(std::string(mode_name(now.mode())) + ": " + now.reason());
    }
    status = now;
  });
  subscribe(topic::sim_truth, [this](const swiftlet_msgs::msg::SimTruth& now) {
    truth = from_msg(now.pose().position());
    velocity = from_msg(now.twist().linear());
    on_ground = now.on_ground();
    contacts = now.contacts();
    last_contact = now.last_contact();
    clearance = now.minimum_clearance();
  });
  subscribe(
      topic::guard_status,
      [this](const swiftlet_msgs::msg::GuardStatus& now) {
        guard_acting = now.acting();
        guard_reason = now.reason();
      },
      Need::kOptional);
  every(kPeriod, [this](Time now) { advance(now); });
}

void ScriptedPilot::command(std::uint8_t what, double altitude) {
  swiftlet_msgs::msg::ModeCommand message;
  message.header(make_header(now(), frame::kMap));
  message.id(fmt::format("pilot-{}", ++commands_));
  message.command(what);
  message.altitude(altitude);
  mode_.publish(message);
}

void ScriptedPilot::go_to(const Eigen::Vector3d& place) {
  waypoints_.publish(make_mission(now(), fmt::format("pilot-{}", ++commands_),
                                  {MissionWaypoint{place, std::nullopt}}));
}

void ScriptedPilot::go_to_global(const GlobalWaypoint& place) {
  waypoints_.publish(make_mission(now(), fmt::format("pilot-{}", ++commands_), {place}));
}

void ScriptedPilot::advance(Time now) {
  if (step_ == script.size()) return stop(0);
  const Step& step = script[step_];
  if (!step_begun_) {
    step_begun_ = now;
    step.begin();
  }
  step_s = to_seconds(now - *step_begun_);
  if (remote) {
    sticks_.publish(to_msg(step.sticks, now, ""));
  }
  // The step's own command needs a moment to arrive.
  if (step_s >= 0.3 && step.done()) {
    ++step_;
    step_begun_.reset();
  } else if (step_s > step.limit_s) {
    failure = fmt::format("'{}' was not done within {:.0f} s", step.name, step.limit_s);
    stop(1);
  }
}

ModeFlight::ModeFlight(const std::string& parameters, std::vector<Fault> faults)
    : host_(lockstep(std::move(faults))) {
  Config config = parameters.empty() ? Config() : Config::parse(parameters, "parameters.yaml");
  config.set("sim.scenario",
             std::string(SWIFTLET_SOURCE_DIR) + "/components/sim/scenarios/courtyard.yaml");
  for (const char* name : {"sim", "estimator", "flight_controller", "lidar_mapper", "planner",
                           "explorer", "guard", "commander"}) {
    components_[name] = &host_.add(name, config.child(name));
  }
  pilot_ = &host_.emplace<ScriptedPilot>("pilot");
}

void ModeFlight::order(std::uint8_t what, const char* mode, double altitude) {
  add({fmt::format("order {}", mode),
       [this, what, altitude] { pilot_->command(what, altitude); },
       [this, mode] { return pilot_->is_in(mode); },
       5.0,
       {}});
}

void ModeFlight::take_off(double altitude) {
  add({"ready", [] {}, [this] { return pilot_->status.ready(); }, 30.0, {}});
  add({"arm",
       [this] { pilot_->command(command_code::ARM); },
       [this] { return pilot_->status.armed(); },
       5.0,
       {}});
  add({"take off",
       [this, altitude] { pilot_->command(command_code::TAKEOFF, altitude); },
       [this] { return pilot_->is_in("Hover"); },
       20.0,
       {}});
}

void ModeFlight::wait(double seconds) {
  hold({}, seconds);
}

void ModeFlight::hold(const Sticks& sticks, double seconds) {
  add({"hold", [] {}, [this, seconds] { return pilot_->step_s >= seconds; }, seconds + 1.0,
       sticks});
}

void ModeFlight::until(const char* mode, double limit_s) {
  add({fmt::format("until {}", mode),
       [] {},
       [this, mode] { return pilot_->is_in(mode); },
       limit_s,
       {}});
}

void ModeFlight::land() {
  order(command_code::LAND, "Land");
  until("Grounded", 60.0);
}

void ModeFlight::fly() {
  host_.run();
  std::string log;
  for (const std::string& line : pilot_->log) log += "  " + line + "\n";
  EXPECT_EQ(pilot_->failure, "") << "at " << pilot_->truth.transpose() << "\n" << log;
  EXPECT_EQ(pilot_->contacts, 0u) << pilot_->last_contact << "\n" << log;
}

}  // namespace swiftlet::test
