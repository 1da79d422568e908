// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/decision_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/command_name.hpp"
#include "components/commander/request_message.hpp"
#include "components/conversions.hpp"
#include "components/mission_state_name.hpp"
#include "components/mode_message.hpp"

namespace swiftlet {
namespace {

namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;

/// Goals that are nearer than this to another are the same place [m].
constexpr double kSamePlace = 0.05;
constexpr std::size_t kMostPlaces = 500;

/// A place that is not there yet.
void add_place(std::vector<Place>& places, Place place) {
  if (!place.position.allFinite() || places.size() >= kMostPlaces) return;
  const bool is_there = std::any_of(places.begin(), places.end(), [&place](const Place& other) {
    return (other.position - place.position).norm() < kSamePlace;
  });
  if (!is_there) places.push_back(std::move(place));
}

std::string because(const std::string& reason) {
  return reason.empty() ? "" : ": " + reason;
}

}  // namespace

void DecisionReader::on_status(double time, const swiftlet_msgs::msg::VehicleStatus& message,
                               const std::optional<Eigen::Vector3d>& position) {
  if (!status_ || status_->mode() != message.mode()) note_mode(time, message, position);
  if (status_ && status_->armed() != message.armed()) {
    story_.events.add(time, Level::kInfo, "mode", message.armed() ? "armed" : "disarmed");
  }
  note_mission(time, message);
  story_.modes.back().to = time;
  phase_.is_known = true;
  phase_.in_flight = message.mode() != mode::GROUNDED;
  phase_.landing = message.mode() == mode::LAND;
  if (phase_.in_flight) phase_.takeoff_point = from_msg(message.takeoff_point());
  status_ = message;
}

void DecisionReader::note_mode(double time, const swiftlet_msgs::msg::VehicleStatus& message,
                               const std::optional<Eigen::Vector3d>& position) {
  const std::string name = mode_name(message.mode());
  if (!story_.modes.empty()) story_.modes.back().to = time;
  story_.modes.push_back({time, time, name});
  if (!status_) return;  // how the recording begins is no change
  story_.events.add(
      time, Level::kInfo, "mode",
      fmt::format("{} → {}{}", mode_name(status_->mode()), name, because(message.reason())));
  if (status_->mode() == mode::GROUNDED) {
    const Eigen::Vector3d point = position.value_or(from_msg(message.takeoff_point()));
    story_.map.takeoffs.push_back({time, point.head<2>(), "take-off"});
  }
  if (message.mode() == mode::GROUNDED && position) {
    story_.map.landings.push_back({time, position->head<2>(), "landing"});
  }
}

void DecisionReader::note_mission(double time, const swiftlet_msgs::msg::VehicleStatus& message) {
  if (!status_ || message.mission_id().empty()) return;
  // Of an uploaded mission, which tells of itself, each run of waypoints is done once.
  if (uploaded_ && uploaded_->id() == message.mission_id()) return;
  if (message.waypoint() != status_->waypoint() && message.waypoint() > 0) {
    story_.events.add(time, Level::kInfo, "mission",
                      fmt::format("on the way to waypoint {} of {}", message.waypoint(),
                                  message.waypoint_count()));
  }
  if (message.mission_done() && !status_->mission_done()) {
    story_.events.add(time, Level::kInfo, "mission", "done");
  }
}

void DecisionReader::on_command(double time, const swiftlet_msgs::msg::ModeCommand& message) {
  const auto request = request_of(message);
  std::string text = request ? to_string(request->kind) : command_name(message.command());
  if (request && request->kind == Request::Kind::kTakeoff) {
    text += fmt::format(" to {:.2f} m", message.altitude());
  }
  if (!asked_.emplace(message.id(), text).second) return;  // said again
  story_.events.add(time, Level::kInfo, "command", text + ": asked for");
}

void DecisionReader::on_ack(double time, const swiftlet_msgs::msg::CommandAck& message) {
  if (!answered_.insert(message.id()).second) return;
  const auto asked = asked_.find(message.id());
  const std::string what = asked != asked_.end()    ? asked->second
                           : message.name().empty() ? fmt::format("command '{}'", message.id())
                                                    : message.name();
  story_.events.add(time, message.accepted() ? Level::kInfo : Level::kWarning, "command",
                    what + (message.accepted() ? ": accepted" : ": refused") +
                        because(message.accepted() ? "" : message.reason()));
}

void DecisionReader::on_mission(double time, const swiftlet_msgs::msg::Mission& message) {
  if (!missions_.insert(message.id()).second) return;
  const std::string text = fmt::format("mission of {} waypoints", message.waypoints().size());
  asked_.emplace(message.id(), text);
  story_.events.add(time, Level::kInfo, "mission", text + ": sent");
  int number = 0;
  for (const swiftlet_msgs::msg::Waypoint& waypoint : message.waypoints()) {
    ++number;
    if (waypoint.is_global()) {
      ++story_.map.global_waypoints;
    } else {
      add_place(story_.map.waypoints,
                {time, from_msg(waypoint.position()).head<2>(), std::to_string(number)});
    }
  }
}

void DecisionReader::on_uploaded(double time, const swiftlet_msgs::msg::MissionState& message) {
  const bool is_new = !uploaded_ || uploaded_->id() != message.id() ||
                      uploaded_->state() != message.state() || uploaded_->item() != message.item();
  const bool is_something = message.count() > 0 || (uploaded_ && uploaded_->count() > 0);
  if (is_new && is_something) {
    story_.events.add(time, Level::kInfo, "mission", mission_state_text(message));
  }
  if (message.upload_refused() &&
      (!uploaded_ || uploaded_->upload_reason() != message.upload_reason())) {
    story_.events.add(time, Level::kWarning, "mission", message.upload_reason());
  }
  uploaded_ = message;
}

void DecisionReader::on_goal(double time, const geometry_msgs::msg::PoseStamped& message) {
  add_place(story_.map.goals, {time, from_msg(message.pose().position()).head<2>(), "goal"});
}

void DecisionReader::on_guard(double time, const swiftlet_msgs::msg::GuardStatus& message,
                              const std::optional<Eigen::Vector3d>& position) {
  if (message.acting() == guard_acts_) return;
  guard_acts_ = message.acting();
  story_.events.add(time, guard_acts_ ? Level::kWarning : Level::kInfo, "guard",
                    guard_acts_ ? "flies instead of the commander" + because(message.reason())
                                : "gives back to the commander");
  if (guard_acts_ && position) {
    add_place(story_.map.guard_acts, {time, position->head<2>(), message.reason()});
  }
}

void DecisionReader::on_trajectory(double time, const swiftlet_msgs::msg::Trajectory& message) {
  const bool failed = message.status() == swiftlet_msgs::msg::Trajectory_Constants::FAILED;
  const std::string failure =
      failed ? (message.reason().empty() ? message.failure() : message.reason()) : "";
  if (failed && failure != planner_failure_) {
    story_.events.add(time, Level::kWarning, "planner", "found no way" + because(failure));
  }
  planner_failure_ = failure;
}

void DecisionReader::on_exploration(double time, const swiftlet_msgs::msg::Exploration& message) {
  using namespace swiftlet_msgs::msg::Exploration_Constants;
  if (exploration_ == message.status()) return;
  exploration_ = message.status();
  const std::string text = message.status() == FINISHED ? "all that can be reached has been seen"
                           : message.status() == STUCK  ? "knows no way from here"
                                                        : "looks around";
  story_.events.add(time, message.status() == STUCK ? Level::kWarning : Level::kInfo, "exploration",
                    text + because(message.reason()));
}

std::string DecisionReader::landed() const {
  if (story_.map.takeoffs.empty() || story_.map.landings.empty()) return "Landed";
  return fmt::format("Landed {:.2f} m from the take-off point", *story_.figures.landing_error);
}

void DecisionReader::finish() {
  FlightFigures& figures = story_.figures;
  if (!story_.map.takeoffs.empty() && !story_.map.landings.empty()) {
    figures.landing_error =
        (story_.map.landings.back().position - story_.map.takeoffs.back().position).norm();
  }
  if (!status_) {
    story_.outcome = {Level::kWarning, "Not known: vehicle/status is not in the recording"};
    return;
  }
  double flight_time = 0.0;
  for (const ModeSpan& span : story_.modes) {
    if (span.mode != mode_name(mode::GROUNDED)) flight_time += span.to - span.from;
  }
  figures.flight_time = flight_time;
  if (figures.contacts.value_or(0) > 0) {
    story_.outcome = {Level::kError, fmt::format("Touched '{}'", figures.last_contact)};
  } else if (status_->mode() != mode::GROUNDED) {
    story_.outcome = {Level::kWarning, fmt::format("The recording ends in flight, in mode {}",
                                                   mode_name(status_->mode()))};
  } else if (flight_time == 0.0) {
    story_.outcome = {Level::kInfo, "Did not take off"};
  } else {
    story_.outcome = {Level::kInfo, landed()};
  }
}

}  // namespace swiftlet
