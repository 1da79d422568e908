// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/state/controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace swiftlet::screen {
namespace {

constexpr std::size_t kLongestText = 60;
/// Of a picture, with one key.
constexpr double kPan = 0.25;

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole = !text.empty() && end == text.c_str() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

Action action(Action::Kind kind) {
  Action action;
  action.kind = kind;
  return action;
}

Action mission(const std::string& name, std::vector<MissionWaypoint> waypoints) {
  Action action;
  action.kind = Action::Kind::kMission;
  action.name = name;
  action.waypoints = std::move(waypoints);
  return action;
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
      if (deed == Deed::kErase) {
        if (!text_.empty()) text_.pop_back();
        return {};
      }
      if (deed == Deed::kAccept) return accept_text(circumstances);
      close();
      return {};
    case Keyboard::kConfirm:
      close();
      if (deed != Deed::kYes) return {};
      if (!asked_to_clear_) return {asked_};
      waypoints_.clear();
      return {};
    case Keyboard::kHelp:
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
      return {action(Kind::kHover)};
    case Deed::kReturn:
      return {action(Kind::kReturn)};
    case Deed::kExplore:
      return {action(Kind::kExplore)};
    case Deed::kManual:
    case Deed::kAssist:
      return steer(deed);
    case Deed::kBeginCursor:
      begin_cursor(Keyboard::kCursor, circumstances);
      return {};
    case Deed::kBeginWaypoints:
      begin_cursor(Keyboard::kWaypoints, circumstances);
      return {};
    case Deed::kBeginParameters:
      parameters_ = {};
      parameters_.components = circumstances.components;
      keyboard_ = Keyboard::kParameters;
      return {};
    case Deed::kLeft:
      camera_.pan(-kPan, 0.0);
      return {};
    case Deed::kRight:
      camera_.pan(kPan, 0.0);
      return {};
    case Deed::kUp:
      camera_.pan(0.0, kPan);
      return {};
    case Deed::kDown:
      camera_.pan(0.0, -kPan);
      return {};
    case Deed::kQuit:
      if (!circumstances.in_flight) return {action(Kind::kQuit)};
      ask("Quit? The vehicle is in flight, and goes on without you.", action(Kind::kQuit));
      return {};
    default:
      look(deed);
      return {};
  }
}

bool Controller::look(Deed deed) {
  switch (deed) {
    case Deed::kZoomIn:
      camera_.zoom_in();
      return true;
    case Deed::kZoomOut:
      camera_.zoom_out();
      return true;
    case Deed::kFollow:
      camera_.follow();
      return true;
    case Deed::kShowAll:
      camera_.show_all();
      return true;
    case Deed::kHelp:
      open(Keyboard::kHelp);
      return true;
    default:
      return false;
  }
}

void Controller::begin_cursor(Keyboard keyboard, const Circumstances& circumstances) {
  const double step = camera_.cursor_step();
  const Eigen::Vector2d at = circumstances.vehicle
                                 ? Eigen::Vector2d(circumstances.vehicle->head<2>())
                                 : camera_.view().centre;
  cursor_ = {std::round(at.x() / step) * step, std::round(at.y() / step) * step};
  keyboard_ = keyboard;
}

void Controller::move_cursor(Deed deed) {
  const double step = camera_.cursor_step();
  const auto move = [step](double& coordinate, int by) {
    coordinate = (std::round(coordinate / step) + by) * step;
  };
  if (deed == Deed::kLeft) move(cursor_->x(), -1);
  if (deed == Deed::kRight) move(cursor_->x(), 1);
  if (deed == Deed::kDown) move(cursor_->y(), -1);
  if (deed == Deed::kUp) move(cursor_->y(), 1);
}

Eigen::Vector3d Controller::place(const Circumstances& circumstances) const {
  const auto& items = waypoints_.items();
  double height = kUsualAltitude;
  if (circumstances.in_flight && circumstances.vehicle) {
    height = std::round(circumstances.vehicle->z() * 10.0) / 10.0;
  }
  const bool has_list = keyboard_ == Keyboard::kWaypoints && !items.empty();
  if (has_list) height = items[static_cast<std::size_t>(waypoints_.selected())].position.z();
  return {cursor_->x(), cursor_->y(), height};
}

std::vector<Action> Controller::use_cursor(Deed deed, const Circumstances& circumstances) {
  if (look(deed)) return {};
  if (deed == Deed::kHover) return {action(Action::Kind::kHover)};
  move_cursor(deed);
  if (deed != Deed::kLeave && deed != Deed::kAccept) return {};
  const Eigen::Vector3d there = place(circumstances);
  keyboard_ = Keyboard::kFly;
  cursor_.reset();
  if (deed == Deed::kLeave) return {};
  return {mission("goto", {{there, std::nullopt}})};
}

std::vector<Action> Controller::edit_waypoints(Deed deed, const Circumstances& circumstances) {
  if (look(deed)) return {};
  move_cursor(deed);
  switch (deed) {
    case Deed::kHover:
      return {action(Action::Kind::kHover)};
    case Deed::kAppend:
      waypoints_.append(place(circumstances));
      return {};
    case Deed::kInsert:
      waypoints_.insert(place(circumstances));
      return {};
    case Deed::kMove:
      waypoints_.move_to(*cursor_);
      return {};
    case Deed::kHeight:
      if (waypoints_.empty()) return {};
      write(Deed::kHeight, fmt::format("Height of waypoint {} [m]", waypoints_.selected() + 1),
            fmt::format("{:g}", place(circumstances).z()));
      return {};
    case Deed::kRemove:
      waypoints_.remove();
      return {};
    case Deed::kClear:
      if (waypoints_.empty()) return {};
      ask(fmt::format("Remove all {} waypoints?", waypoints_.items().size()), {});
      asked_to_clear_ = true;
      return {};
    case Deed::kNext:
      waypoints_.select_next();
      return {};
    case Deed::kPrevious:
      waypoints_.select_previous();
      return {};
    case Deed::kEarlier:
      waypoints_.earlier();
      return {};
    case Deed::kLater:
      waypoints_.later();
      return {};
    case Deed::kStart:
      if (waypoints_.empty()) return {};
      keyboard_ = Keyboard::kFly;
      cursor_.reset();
      return {mission(fmt::format("mission of {}", waypoints_.items().size()), waypoints_.items())};
    case Deed::kLeave:
      keyboard_ = Keyboard::kFly;
      cursor_.reset();
      return {};
    default:
      return {};
  }
}

std::vector<Action> Controller::edit_parameters(Deed deed, const Circumstances& circumstances) {
  ParameterList& list = parameters_;
  if (deed == Deed::kUp) list.selected = std::max(0, list.selected - 1);
  if (deed == Deed::kDown)
    list.selected = std::max(0, std::min(list.size() - 1, list.selected + 1));
  if (deed == Deed::kLeave) {
    if (list.component.empty()) {
      keyboard_ = Keyboard::kFly;
    } else {
      list = {};
      list.components = circumstances.components;
    }
  }
  if (deed != Deed::kAccept || list.size() == 0) return {};
  const auto selected = static_cast<std::size_t>(std::max(0, list.selected));
  if (list.component.empty()) {
    list.component = list.components.at(selected);
    list.selected = 0;
    Action ask = action(Action::Kind::kListParameters);
    ask.component = list.component;
    return {ask};
  }
  const ParameterEntry& entry = list.entries.at(selected);
  write(Deed::kBeginParameters, fmt::format("{}.{}", list.component, entry.name), entry.value);
  return {};
}

std::vector<Action> Controller::accept_text(const Circumstances&) {
  const std::optional<double> value = number(text_);
  if (about_ == Deed::kBeginParameters) {
    close();
    const auto selected = static_cast<std::size_t>(parameters_.selected);
    if (selected >= parameters_.entries.size()) return {};  // they are others by now
    Action set = action(Action::Kind::kSetParameter);
    set.component = parameters_.component;
    set.name = parameters_.entries[selected].name;
    set.value = text_;
    return {set};
  }
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
  asked_to_clear_ = false;
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
