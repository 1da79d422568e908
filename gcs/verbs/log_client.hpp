// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "gcs/screen/shell/vehicle_listener.hpp"
#include "gcs/verbs/command_log.hpp"

namespace swiftlet {

/// Told of each event as it happens.
using TellEvent = std::function<void(const screen::Event&)>;

/// Tells what happens to a vehicle: changes of mode, commands and what became of them, the mission,
/// the health of components, battery and link. It shows itself to nobody, so that nobody misses it.
class LogClient : public screen::VehicleListener {
 public:
  /// Ends the run after `length`, where there is one: 0 where a vehicle was heard, else 1.
  LogClient(const ComponentContext& context, std::optional<Duration> length, TellEvent tell);

 private:
  void advance(Time now);

  TellEvent tell_;
  CommandLog commands_;
  std::size_t told_ = 0;  // number of the last event that was looked at
};

/// "12:34:56 Takeoff → Hover: 1.20 m reached", and {"time": ..., "severity": ..., "text": ...} on a
/// line.
std::string line_of(const screen::Event& event);
std::string json_line_of(const screen::Event& event);

}  // namespace swiftlet
