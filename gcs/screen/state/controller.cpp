// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace swiftlet::screen {
namespace {

/// Paths of files are the longest.
constexpr std::size_t kLongestText = 200;

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole = !text.empty() && end == text.c_str() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// "47.39775 8.54570 10", with commas or without; its altitude may be left out.
std::optional<GlobalWaypoint> global_place(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    const std::optional<double> value = number(word);
    if (!value) return std::nullopt;
    numbers.push_back(*value);
  }
  if (numbers.size() < 2 || numbers.size() > 3) return std::nullopt;
  return GlobalWaypoint{numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 0.0};
}

}  // namespace

std::vector<Action> Controller::press(KeyCode key, const Circumstances& circumstances) {
  const Binding* binding = find_binding(keyboard_, key);
  if (keyboard_ == Keyboard::kSticks) {
    if (binding != nullptr && binding->deed == Deed::kLeave) return steer(Deed::kLeave);
    const bool is_character = is_printable(key);
    key_sticks_.press(is_character ? swiftlet::key(static_cast<char>(key)) : swiftlet::key(' '),
                      circumstances.now);
    return {};
  }
  if (keyboard_ == Keyboard::kText && is_printable(key)) {
    if (text_.size() < kLongestText) text_ += static_cast<char>(key);
    return {};
  }
  if (binding == nullptr) return {};
  const Deed deed = binding->deed;
  switch (keyboard_) {
    case Keyboard::kFly:
      return fly(deed, circumstances);
    case Keyboard::kCursor:
      return use_cursor(deed, circumstances);
    case Keyboard::kWaypoints:
      return edit_waypoints(deed, circumstances);
    case Keyboard::kParameters:
      return edit_parameters(deed, circumstances);
    case Keyboard::kText:
      return edit_text(deed);
    case Keyboard::kConfirm:
      return answer(deed);
    case Keyboard::kEvents:
      view_events(deed);
      return {};
    case Keyboard::kHelp:
    case Keyboard::kLink:
      close();
      return {};
    case Keyboard::kSticks:
      break;
  }
  return {};
}

std::vector<Action> Controller::fly(Deed deed, const Circumstances& circumstances) {
  using Kind = Action::Kind;
  switch (deed) {
    case Deed::kArm:
      ask("Arm? The rotors will turn.", action(Kind::kArm));
      return {};
    case Deed::kDisarm:
      return {action(Kind::kDisarm)};
    case Deed::kTakeoff:
      write(Deed::kTakeoff, "Take off to how many metres?", fmt::format("{:g}", kUsualAltitude));
      return {};
    case Deed::kLand:
      return {action(Kind::kLand)};
    case Deed::kHover:
      return hover(circumstances);
    case Deed::kGoOn:
      return go_on(circumstances);
    case Deed::kReturn:
      return {action(Kind::kReturn)};
    case Deed::kExplore:
      return {action(Kind::kExplore)};
    case Deed::kManual:
    case Deed::kAssist:
      return steer(deed);
    case Deed::kOpenClaw:
      if (!circumstances.in_flight) return {action(Kind::kOpenClaw)};
      ask("Open the claw? What it holds will fall.", action(Kind::kOpenClaw));
      return {};
    case Deed::kCloseClaw:
      return {action(Kind::kCloseClaw)};
    case Deed::kBeginEvents:
      events_up_ = 0;
      open(Keyboard::kEvents);
      return {};
    case Deed::kBeginLink:
      open(Keyboard::kLink);
      return {};
    case Deed::kGoToGlobal:
      ask_for_global(deed);
      return {};
    case Deed::kControl:
      if (!circumstances.has_control) return {action(Kind::kTakeControl)};
      write(Deed::kControl, "Give control to which station (none: to the next)?", "");
      return {};
    case Deed::kBeginCursor:
      begin_cursor(Keyboard::kCursor, circumstances);
      return {};
    case Deed::kBeginWaypoints:
      begin_cursor(Keyboard::kWaypoints, circumstances);
      return {};
    case Deed::kBeginParameters:
      begin_parameters(circumstances);
      return {};
    case Deed::kQuit:
      if (!circumstances.in_flight) return {action(Kind::kQuit)};
      ask("Quit? The vehicle is in flight, and goes on without you.", action(Kind::kQuit));
      return {};
    default:
      if (!look(deed)) map_.pan(deed);
      return {};
  }
}

bool Controller::look(Deed deed) {
  if (deed != Deed::kHelp) return map_.look(deed);
  open(Keyboard::kHelp);
  return true;
}

void Controller::begin_cursor(Keyboard keyboard, const Circumstances& circumstances) {
  map_.begin_cursor(circumstances.vehicle);
  keyboard_ = keyboard;
}

void Controller::end_cursor() {
  map_.end_cursor();
  keyboard_ = Keyboard::kFly;
}

Eigen::Vector3d Controller::place(const Circumstances& circumstances) const {
  double height = kUsualAltitude;
  if (circumstances.in_flight && circumstances.vehicle) {
    height = std::round(circumstances.vehicle->z() * 10.0) / 10.0;
  }
  if (keyboard_ == Keyboard::kWaypoints) height = waypoints_.height_nearby().value_or(height);
  return {cursor()->x(), cursor()->y(), height};
}

std::vector<Action> Controller::use_cursor(Deed deed, const Circumstances& circumstances) {
  if (look(deed)) return {};
  if (deed == Deed::kHover) return hover(circumstances);
  if (deed == Deed::kGoOn) return go_on(circumstances);
  map_.move_cursor(deed);
  if (deed != Deed::kLeave && deed != Deed::kAccept) return {};
  Action go_to = action(Action::Kind::kGoTo);
  go_to.place = place(circumstances);
  end_cursor();
  if (deed == Deed::kLeave) return {};
  return {go_to};
}

/// A mission that is only told to hover goes on by itself where it waits; one that is paused does
/// not.
std::vector<Action> Controller::hover(const Circumstances& circumstances) const {
  return {action(circumstances.mission_flies ? Action::Kind::kPauseMission : Action::Kind::kHover)};
}

/// Through the first item only by `s` of the list, which is asked for by name.
std::vector<Action> Controller::go_on(const Circumstances& circumstances) const {
  if (!circumstances.mission_done) return {action(Action::Kind::kGoOn)};
  return {message(Action::Kind::kTell, Severity::kCaution,
                  "the mission is done; w m s flies it again from its first item")};
}

std::vector<Action> Controller::edit_text(Deed deed) {
  if (deed == Deed::kAccept) return accept_text();
  if (deed == Deed::kErase) {
    if (!text_.empty()) text_.pop_back();
  } else if (deed == Deed::kEraseAll) {
    text_.clear();
  } else {
    close();
  }
  return {};
}

std::vector<Action> Controller::accept_text() {
  if (about_ == Deed::kBeginParameters) return accept_parameter();
  if (about_ == Deed::kControl) return accept_successor();
  if (about_ == Deed::kGoToGlobal || about_ == Deed::kAppendGlobal) return accept_global();
  if (about_ == Deed::kSave || about_ == Deed::kLoad) return accept_file(about_);
  const std::optional<double> value = number(text_);
  // What is no number stays, to be put right.
  if (!value) return {};
  close();
  if (about_ == Deed::kHeight) {
    waypoints_.set_height(*value);
    return {};
  }
  Action takeoff = action(Action::Kind::kTakeoff);
  takeoff.altitude = *value;
  return {takeoff};
}

void Controller::ask_for_global(Deed about) {
  write(about, "Latitude and longitude [deg], altitude [m] or none?", "");
}

std::vector<Action> Controller::accept_global() {
  const std::optional<GlobalWaypoint> place = global_place(text_);
  if (!place) return {};  // it stays, to be put right
  close();
  if (about_ == Deed::kAppendGlobal) {
    waypoints_.append_global(*place);
    return {};
  }
  Action go_to = action(Action::Kind::kGoToGlobal);
  go_to.global = *place;
  return {go_to};
}

void Controller::view_events(Deed deed) {
  constexpr int kStep = 3;
  if (deed == Deed::kLeave) close();
  if (deed == Deed::kUp) events_up_ = events_up_ + kStep;
  if (deed == Deed::kDown) events_up_ = std::max(events_up_ - kStep, 0);
}

std::vector<Action> Controller::accept_successor() {
  close();
  Action give = action(text_.empty() ? Action::Kind::kReleaseControl : Action::Kind::kGiveControl);
  give.name = text_;
  return {give};
}

std::vector<Action> Controller::answer(Deed deed) {
  close();
  if (deed != Deed::kYes) return {};
  if (asked_) return {*asked_};
  waypoints_.clear();
  return {};
}

std::vector<Action> Controller::steer(Deed deed) {
  if (deed == Deed::kLeave) {
    keyboard_ = Keyboard::kFly;
    return {action(Action::Kind::kHover)};
  }
  const bool assisted = deed == Deed::kAssist;
  key_sticks_ = KeySticks(assisted);
  keyboard_ = Keyboard::kSticks;
  return {action(assisted ? Action::Kind::kAssist : Action::Kind::kManual)};
}

std::optional<Sticks> Controller::sticks(Time now) const {
  if (keyboard_ != Keyboard::kSticks) return std::nullopt;
  return key_sticks_.at(now);
}

void Controller::ask(const std::string& question, Action action) {
  prompt_ = question;
  asked_ = std::move(action);
  open(Keyboard::kConfirm);
}

void Controller::write(Deed about, const std::string& prompt, const std::string& text) {
  about_ = about;
  prompt_ = prompt;
  text_ = text;
  open(Keyboard::kText);
}

void Controller::open(Keyboard keyboard) {
  below_ = keyboard_;
  keyboard_ = keyboard;
}

}  // namespace swiftlet::screen
