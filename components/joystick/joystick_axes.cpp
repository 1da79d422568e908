// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/joystick/joystick_axes.hpp"

#include <algorithm>

namespace swiftlet {

void JoystickAxes::set_range(int code, int low, int high) {
  if (low < high) ranges_[code] = {low, high};
}

void JoystickAxes::hear(const input_event& event) {
  if (event.type == EV_ABS) values_[event.code] = event.value;
  const bool pressed = event.type == EV_KEY && event.code == params_.assist && event.value == 1;
  if (pressed) assisted_ = !assisted_;
}

/// From -1 at the low end to 1 at the high one; an axis that was not heard is at its centre.
double JoystickAxes::position(int code) const {
  const auto value = values_.find(code);
  if (value == values_.end()) return 0.0;
  const auto known = ranges_.find(code);
  const Range range = known == ranges_.end() ? Range{} : known->second;
  const double middle = 0.5 * (static_cast<double>(range.low) + range.high);
  const double half = 0.5 * (static_cast<double>(range.high) - range.low);
  return std::clamp((value->second - middle) / half, -1.0, 1.0);
}

Sticks JoystickAxes::sticks() const {
  return {-position(params_.forward), -position(params_.left), -position(params_.up),
          -position(params_.turn), assisted_};
}

}  // namespace swiftlet
