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
  Time begun{};            ///< when it came first
  Time previous{};         ///< when it came last but once
  std::size_t number = 0;  ///< of all that was ever added, from 1; of the same again the last
};

/// "12:34:56", by the clock on the wall.
std::string clock_text(Time time);
/// With how often it came, where that is more than once.
std::string text_of(const Event& event);
/// For who tells events one after the other: whether to tell of this one now. The same again is
/// told of once more when another EventLog::kSoon has passed.
bool is_news(const Event& event);

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
  std::size_t added_ = 0;
};

}  // namespace swiftlet::screen
