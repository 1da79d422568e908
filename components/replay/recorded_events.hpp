// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/bag/recording.hpp"
#include "components/runtime/message.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// A message of a recording.
struct RecordedMessage {
  std::string topic;  ///< as recorded
  Time time{};
  Cdr cdr;
};

/// The messages of a recording, divided into inputs of what is run again and its outputs, in the
/// order of log time, and of the file where times are the same: the order in which the recorder got
/// them. What stands between two inputs tells what had happened before the second came.
class RecordedEvents {
 public:
  /// Outputs are what `components` wrote on `topics`, or on channels that do not say who wrote.
  RecordedEvents(const Recording& recording, const std::set<std::string>& topics,
                 const std::set<std::string>& components);

  bool is_output(const mcap::Channel& channel) const;
  /// When the last message was recorded.
  Time end() const { return end_; }

  /// The inputs that come next, all of one time, with no output between; empty at the end.
  const std::vector<RecordedMessage>& batch() const { return batch_; }
  /// Reads on to the next batch. The outputs up to there are then expected.
  void advance();

  /// Outputs of the batch's own time that were recorded before it, counted by topic.
  const std::map<std::string, int>& outputs_before_batch() const { return before_batch_; }

  /// The next recorded output of a topic that is not after `time`, which is then done with; nothing
  /// where there is none up to the present batch.
  std::optional<RecordedMessage> take_expected(const std::string& topic, Time time);
  /// Outputs that were recorded and not taken, by topic.
  std::map<std::string, std::size_t> not_taken() const;

  /// Of chunks that could not be read so far: where, and what is wrong with them.
  const std::vector<Error>& damage() const { return damage_; }
  std::uint64_t inputs() const { return inputs_; }

 private:
  struct Event {
    RecordedMessage message;
    bool is_output = false;
  };
  std::optional<Event> read();

  std::set<std::string> topics_;
  std::set<std::string> components_;
  Time end_{};
  RecordingCursor cursor_;
  std::optional<Event> next_;
  std::vector<RecordedMessage> batch_;
  std::map<std::string, int> before_batch_;
  std::map<std::string, std::deque<RecordedMessage>> expected_;
  std::vector<Error> damage_;
  std::uint64_t inputs_ = 0;
};

}  // namespace swiftlet
