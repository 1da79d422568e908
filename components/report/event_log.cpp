// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/event_log.hpp"

#include <algorithm>
#include <utility>

namespace swiftlet {

void EventLog::add(double time, FlightEvent::Level level, const std::string& kind,
                   std::string text) {
  if (++counts_[kind] > kMostOfAKind) {
    ++left_out_[kind];
    return;
  }
  events_.push_back({time, level, kind, std::move(text)});
}

std::vector<FlightEvent> EventLog::sorted() const {
  std::vector<FlightEvent> events = events_;
  std::stable_sort(events.begin(), events.end(),
                   [](const FlightEvent& a, const FlightEvent& b) { return a.time < b.time; });
  return events;
}

}  // namespace swiftlet
