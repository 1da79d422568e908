// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "components/runtime/dds/participant.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// What is known of one input of a component: from whom it comes, and whether it comes as often as
/// it should.
///
/// Of several writers one is heard at a time: another only after the first was silent for three
/// periods. So a process that comes back to life, or a second one that starts by mistake, cannot
/// put its word between.
class InputWatch {
 public:
  /// `period` is the longest time between two messages of a topic that works, zero for a topic
  /// without one: its messages may come from anybody at any time.
  explicit InputWatch(std::string topic, Duration period)
      : topic_(std::move(topic)), period_(period) {}

  /// Whether a message from that writer is heard; it counts as one that came.
  bool accept(const EndpointGuid& writer, Time now);

  /// Notes the number of messages since the last call, several times a second.
  void sample_rate(Time now);
  /// What is wrong with the input.
  struct Problem {
    std::string text;      ///< "scan: nobody writes it"; "" where nothing is
    bool missing = false;  ///< nothing comes at all, as opposed to too little
  };
  Problem problem(Time now, int matched_writers) const;

  const std::string& topic() const { return topic_; }
  bool periodic() const { return period_ > Duration(0); }

 private:
  struct Count {
    Time time{};
    std::uint64_t messages = 0;
  };
  static constexpr std::size_t kCounts = 6;
  std::optional<double> rate_hz() const;

  std::string topic_;
  Duration period_;
  EndpointGuid source_{};
  std::optional<Time> heard_;
  std::uint64_t messages_ = 0;
  std::array<Count, kCounts> counts_{};  // the newest last
  std::size_t samples_ = 0;
};

}  // namespace swiftlet
