// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/loss_ledger.hpp"

namespace swiftlet {

/// What a recording tells of one topic.
struct TopicHealth {
  std::string topic;
  std::string type;
  bool is_sensor = false;
  /// The longest time between two messages while all is well [s], as components/topics.hpp has it;
  /// nothing where messages come when there is something to say.
  std::optional<double> period;
  std::uint64_t messages = 0;
  double first = 0.0, last = 0.0;  ///< message, since the beginning of the recording [s]
  double largest_gap = 0.0;        ///< between two messages, or the last and the end [s]
  double largest_gap_at = 0.0;     ///< its beginning [s]
  std::uint64_t silences = 0;      ///< gaps of more than three periods
  Loss loss;                       ///< where the recording has a ledger
  std::uint64_t unreadable = 0;    ///< messages that are not of their type

  double rate_hz() const;  ///< between the first and the last; 0 of fewer than two
  /// Fewer than promised, by more than 2 %, or silent for more than three periods.
  bool too_slow() const;
  bool is_lame() const { return too_slow() || silences > 0; }
};

/// Follows the messages of one topic.
class TopicWatch {
 public:
  TopicWatch(std::string topic, std::string type);

  /// Times in order [s]. Returns a silence that ended with this message [s].
  std::optional<double> add(double time);
  void add_unreadable() { ++health_.unreadable; }
  /// What there is to say when the recording ends. A topic that was heard once and fell silent was
  /// silent until then.
  TopicHealth finish(double end) const;

 private:
  void note_gap(double gap, double at);

  TopicHealth health_;
};

/// Whether a topic of the stack has measurements of a sensor, and how often it comes.
struct TopicPromise {
  bool is_sensor = false;
  std::optional<double> period;  ///< [s]
};
TopicPromise promise_of(const std::string& topic);

/// The sensors of which components/topics.hpp promises a rate.
std::vector<std::string> sensor_topics();

}  // namespace swiftlet
