// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>

#include "estimation/basics/time.hpp"

namespace swiftlet::screen {

enum class Severity { kNote, kSuccess, kCaution, kDanger };

struct Event {
  Time time{};
  Severity severity = Severity::kNote;
  std::string text;
  int times = 1;
};

/// What happened, the oldest first; the oldest is forgotten when it is full. The same again is one
/// event that counts up, with the newest numbers in it: notes in a row, and what comes and goes
/// (anything else) also with little between.
class EventLog {
 public:
  static constexpr std::size_t kCapacity = 500;
  /// So many events and so much time may lie between.
  static constexpr std::size_t kNear = 8;
  static constexpr Duration kSoon = std::chrono::seconds(10);

  void add(Time time, Severity severity, const std::string& text);
  const std::deque<Event>& events() const { return events_; }

 private:
  std::deque<Event> events_;
};

}  // namespace swiftlet::screen
