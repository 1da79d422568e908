// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/mission_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace swiftlet {
namespace {

bool is_in(Mode mode, std::initializer_list<Mode> modes) {
  return std::find(modes.begin(), modes.end(), mode) != modes.end();
}

}  // namespace

const char* to_string(MissionRunner::State state) {
  switch (state) {
    case MissionRunner::State::kNone:
      return "none";
    case MissionRunner::State::kReady:
      return "ready";
    case MissionRunner::State::kFlying:
      return "flying";
    case MissionRunner::State::kPaused:
      return "paused";
    case MissionRunner::State::kDone:
      return "done";
  }
  return "none";
}

Status MissionRunner::load(std::vector<MissionItem> items, const FlightDirector& director) {
  if (memory_.state == State::kFlying) {
    return Error{"mission refused: another one is being flown; pause it first"};
  }
  if (items.empty()) return Error{"mission refused: it has no items"};
  if (items.size() > params_.most_items) {
    return Error{fmt::format("mission refused: it has {} items, {} are the most", items.size(),
                             params_.most_items)};
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::string problem = problem_of(items[i]);
    const bool is_in_map = items[i].kind == Kind::kWaypoint && !items[i].global;
    if (problem.empty() && is_in_map) problem = director.waypoint_problem(items[i].place);
    if (!problem.empty()) return Error{fmt::format("mission refused: item {}: {}", i + 1, problem)};
  }
  items_ = std::move(items);
  const std::optional<bool> claw_open = memory_.claw_open;
  memory_ = Memory{};
  memory_.state = State::kReady;
  memory_.claw_open = claw_open;
  return {};
}

Status MissionRunner::clear() {
  if (memory_.state == State::kFlying) {
    return Error{"mission clear refused: it is being flown; pause it first"};
  }
  restore({State::kNone, 0, 0, {}, "", memory_.claw_open}, {});
  return {};
}

void MissionRunner::restore(const Memory& memory, std::vector<MissionItem> items) {
  memory_ = memory;
  items_ = std::move(items);
}

Result<Acceptance> MissionRunner::start(std::size_t item, FlightDirector& director,
                                        const std::optional<LocalOrigin>& origin, Time now) {
  if (items_.empty()) return Error{"mission start refused: there is none; upload one first"};
  if (item > items_.size()) {
    return Error{fmt::format("mission start refused: there is no item {}, the mission has {}", item,
                             items_.size())};
  }
  if (memory_.state == State::kFlying && (item == 0 || item == memory_.item + 1)) {
    return Acceptance::kUnchanged;
  }
  const Memory before = memory_;
  const bool resumes = item == 0 && memory_.state == State::kPaused;
  if (item > 0) memory_.item = item - 1;
  if (item == 0 && !resumes) memory_.item = 0;
  if (memory_.item >= items_.size()) memory_.item = 0;  // that of another mission
  const Result<Acceptance> begun = begin(director, origin, now);
  if (!begun.ok()) {
    memory_ = before;
    return Error{fmt::format("mission start refused: {}", begun.error().reason)};
  }
  memory_.state = State::kFlying;
  memory_.reason.clear();
  return Acceptance::kChanged;
}

Result<Acceptance> MissionRunner::pause(FlightDirector& director, Time now) {
  if (memory_.state == State::kPaused) return Acceptance::kUnchanged;
  if (memory_.state != State::kFlying) {
    return Error{"mission pause refused: no mission is being flown"};
  }
  const Result<Acceptance> stopped = director.request(Request::hover(), now);
  if (!stopped.ok()) return stopped;
  interrupt("pause requested");
  return Acceptance::kChanged;
}

void MissionRunner::interrupt(const std::string& reason) {
  memory_.state = State::kPaused;
  memory_.reason = reason;
  memory_.waiting_since.reset();
}

/// Waypoints in a row, all on Earth or none, up to the first to hold at.
std::size_t MissionRunner::end_of_run(std::size_t first) const {
  std::size_t end = first;
  while (end < items_.size() && items_[end].kind == Kind::kWaypoint &&
         items_[end].global.has_value() == items_[first].global.has_value()) {
    if (items_[end++].hold > 0.0) break;
  }
  return end;
}

Result<Acceptance> MissionRunner::fly_run(FlightDirector& director,
                                          const std::optional<LocalOrigin>& origin, Time now) {
  const bool is_global = items_[memory_.item].global.has_value();
  if (is_global && !origin) {
    return Error{"nobody says where on Earth the map is; is there a GPS fix?"};
  }
  const double home_z = director.status(now).home.z();
  std::vector<MissionWaypoint> waypoints;
  for (std::size_t i = memory_.item; i < memory_.run_end; ++i) {
    waypoints.push_back(items_[i].place);
    if (!is_global) continue;
    const auto place = place_of(*items_[i].global, *origin, params_.gps_altitude, home_z);
    if (!place.ok()) return Error{fmt::format("item {}: {}", i + 1, place.error().reason)};
    waypoints.back().position = *place;
  }
  const auto identity = static_cast<std::uint64_t>(now.time_since_epoch().count());
  const std::size_t number = memory_.item + 1;
  return is_global ? director.fly_straight(identity, waypoints, now, number)
                   : director.fly(identity, waypoints, now, number);
}

/// As it came: a way that was straight over the Earth, where no map may lead home, is straight
/// back.
Result<Acceptance> MissionRunner::fly_back(FlightDirector& director, Time now) {
  const auto is_waypoint = [](const MissionItem& item) { return item.kind == Kind::kWaypoint; };
  const auto end = items_.rend(), begin = end - static_cast<std::ptrdiff_t>(memory_.item);
  const auto last = std::find_if(begin, end, is_waypoint);
  const FlightDirector::Status status = director.status(now);
  if (last != end && last->global && status.mode == Mode::kHover) {
    MissionWaypoint home;
    home.position = status.home;
    home.position.z() += status.height;
    const auto identity = static_cast<std::uint64_t>(now.time_since_epoch().count());
    const auto begun = director.fly_straight(identity, {home}, now, memory_.item + 1);
    if (!begun.ok()) return begun;
  }
  return director.request(Request::go_back(), now);
}

Result<Acceptance> MissionRunner::begin(FlightDirector& director,
                                        const std::optional<LocalOrigin>& origin, Time now) {
  const MissionItem& item = items_[memory_.item];
  memory_.run_end = memory_.item + 1;
  memory_.waiting_since.reset();
  switch (item.kind) {
    case Kind::kTakeoff:
      if (is_in(director.status(now).mode, {Mode::kGrounded, Mode::kTakeoff})) {
        return director.request(Request::takeoff(item.altitude), now);
      }
      return director.request(Request::hover(), now);
    case Kind::kWaypoint:
      memory_.run_end = end_of_run(memory_.item);
      return fly_run(director, origin, now);
    case Kind::kHold:
      memory_.waiting_since = now;
      return director.request(Request::hover(), now);
    case Kind::kLand:
      return director.request(Request::land(), now);
    case Kind::kReturn:
      return fly_back(director, now);
    case Kind::kClaw:
      memory_.waiting_since = now;
      memory_.claw_open = item.open;
      claw_ = ClawProgress::kMoving;  // what it said before was about something else
      return Acceptance::kChanged;
  }
  return Error{"there is no such item"};
}

/// Whether the vehicle still does what the item is about.
bool MissionRunner::goes_on(const FlightDirector::Status& status) const {
  switch (items_[memory_.item].kind) {
    case Kind::kTakeoff:
      return is_in(status.mode, {Mode::kTakeoff, Mode::kHover});
    case Kind::kWaypoint:
      if (memory_.waiting_since) return status.mode == Mode::kHover;
      return is_in(status.mode, {Mode::kIndoorNavigation, Mode::kGpsGuidance}) ||
             (status.mode == Mode::kHover && status.mission_done);
    case Kind::kHold:
      return status.mode == Mode::kHover;
    case Kind::kLand:
      return is_in(status.mode, {Mode::kLand, Mode::kGrounded});
    case Kind::kReturn:
      return is_in(status.mode,
                   {Mode::kIndoorNavigation, Mode::kGpsGuidance, Mode::kLand, Mode::kGrounded});
    case Kind::kClaw:
      return is_in(status.mode, {Mode::kHover, Mode::kGrounded});
  }
  return false;
}

bool MissionRunner::is_finished(const FlightDirector::Status& status, Time now) {
  const MissionItem& item = items_[memory_.item];
  switch (item.kind) {
    case Kind::kTakeoff:
      return status.mode == Mode::kHover;
    case Kind::kWaypoint: {
      if (status.mode != Mode::kHover) return false;
      const double hold = items_[memory_.run_end - 1].hold;
      if (!memory_.waiting_since) memory_.waiting_since = now;
      return to_seconds(now - *memory_.waiting_since) >= hold;
    }
    case Kind::kHold:
      return to_seconds(now - memory_.waiting_since.value_or(now)) >= item.hold;
    case Kind::kLand:
    case Kind::kReturn:
      return status.mode == Mode::kGrounded;
    case Kind::kClaw:
      return claw_ == (item.open ? ClawProgress::kOpen : ClawProgress::kClosed);
  }
  return false;
}

/// Why the claw is not waited for any longer; "" while it is.
std::string MissionRunner::claw_problem(Time now) const {
  const MissionItem& item = items_[memory_.item];
  if (item.kind != Kind::kClaw) return "";
  const char* what = item.open ? "open" : "close";
  const double waited = to_seconds(now - memory_.waiting_since.value_or(now));
  if (claw_ == ClawProgress::kFault && waited > params_.claw_reaction) {
    return fmt::format("the claw does not {}: it has a fault", what);
  }
  if (waited <= params_.claw_timeout) return "";
  return fmt::format("the claw does not {} within {:.1f} s; is it running?", what,
                     params_.claw_timeout);
}

void MissionRunner::tick(FlightDirector& director, const std::optional<LocalOrigin>& origin,
                         Time now) {
  if (memory_.state != State::kFlying) return;
  if (memory_.item >= items_.size() || memory_.run_end > items_.size()) {
    return interrupt("its items were not handed over by the commander before");
  }
  const FlightDirector::Status status = director.status(now);
  if (items_[memory_.item].kind == Kind::kWaypoint && !memory_.waiting_since) {
    memory_.item = std::clamp(status.number, memory_.item + 1, memory_.run_end) - 1;
  }
  if (!goes_on(status)) return interrupt(status.reason);
  if (!is_finished(status, now)) {
    const std::string problem = claw_problem(now);
    if (!problem.empty()) interrupt(problem);
    return;
  }
  if (memory_.run_end == items_.size()) {
    memory_.state = State::kDone;
    return;
  }
  memory_.item = memory_.run_end;
  const Result<Acceptance> begun = begin(director, origin, now);
  if (!begun.ok()) interrupt(begun.error().reason);
}

}  // namespace swiftlet
