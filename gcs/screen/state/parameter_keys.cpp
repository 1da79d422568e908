// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The keyboard on which parameters are chosen and changed.
#include <fmt/format.h>

#include <algorithm>

#include "gcs/screen/state/controller.hpp"

namespace swiftlet::screen {

void Controller::begin_parameters(const Circumstances& circumstances) {
  parameters_ = {};
  parameters_.components = circumstances.components;
  keyboard_ = Keyboard::kParameters;
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
      begin_parameters(circumstances);
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
  using Changes = ParameterEntry::Changes;
  const bool too_late = entry.changes == Changes::kOnGround && circumstances.in_flight;
  if (entry.changes == Changes::kAtStart || too_late) {
    const char* when = too_late ? "changes before lift-off, not in flight"
                                : "is used when the component starts, and does not change";
    return {message(Action::Kind::kTell, Severity::kCaution,
                    fmt::format("{}.{} {}", list.component, entry.name, when))};
  }
  write(Deed::kBeginParameters, fmt::format("{}.{}", list.component, entry.name), entry.value);
  return {};
}

std::vector<Action> Controller::accept_parameter() {
  close();
  const auto selected = static_cast<std::size_t>(parameters_.selected);
  if (selected >= parameters_.entries.size()) return {};  // they are others by now
  Action set = action(Action::Kind::kSetParameter);
  set.component = parameters_.component;
  set.name = parameters_.entries[selected].name;
  set.value = text_;
  return {set};
}

}  // namespace swiftlet::screen
