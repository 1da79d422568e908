// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/command_authority.hpp"

#include <fmt/format.h>

namespace swiftlet {

Status CommandAuthority::claim(const std::string& station, Time now) {
  const std::string& current = holder(now);
  if (!current.empty() && current != station) {
    return Error{
        fmt::format("station '{}' has control, not '{}'; it can hand it over (swiftlet gcs control "
                    "give {}), and loses it when it was not heard for {:g} s",
                    current, station, station, to_seconds(lease_))};
  }
  state_ = {station, now, ""};
  return {};
}

Status CommandAuthority::take(const std::string& station, Time now) {
  if (!station.empty() && station == state_.giver) state_ = {};
  return claim(station, now);
}

void CommandAuthority::hear(const std::string& station, Time now) {
  if (station.empty() || holder(now) != station) return;
  state_.heard = now;
  state_.giver.clear();
}

Status CommandAuthority::give(const std::string& station, const std::string& successor, Time now) {
  if (successor.empty()) return Error{"give it to whom?"};
  if (Status claimed = claim(station, now); !claimed.ok()) return claimed;
  state_.holder = successor;
  if (successor != station) state_.giver = station;
  return {};
}

Status CommandAuthority::release(const std::string& station, Time now) {
  if (Status claimed = claim(station, now); !claimed.ok()) return claimed;
  state_ = {};
  return {};
}

const std::string& CommandAuthority::holder(Time now) const {
  static const std::string kNobody;
  return now - state_.heard > lease_ ? kNobody : state_.holder;
}

}  // namespace swiftlet
