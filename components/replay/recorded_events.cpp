// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/replay/recorded_events.hpp"

#include <utility>

#include "components/bag/mcap/bytes.hpp"
#include "components/bag/recording_records.hpp"
#include "components/bag/topic_selection.hpp"

namespace swiftlet {

RecordedEvents::RecordedEvents(const Recording& recording, const std::set<std::string>& topics,
                               const std::set<std::string>& components)
    : topics_(topics),
      components_(components),
      end_(mcap::to_time(recording.statistics().message_end_time)),
      cursor_(recording.messages()),
      next_(read()) {
  advance();
}

bool RecordedEvents::is_output(const mcap::Channel& channel) const {
  if (topics_.count(without_slash(channel.topic)) == 0) return false;
  const auto component = channel.metadata.find(kChannelComponentKey);
  return component == channel.metadata.end() || components_.count(component->second) != 0;
}

std::optional<RecordedEvents::Event> RecordedEvents::read() {
  for (;;) {
    const auto next = cursor_.next();
    if (!next.ok()) {
      damage_.push_back(next.error());
      continue;
    }
    if (!*next) return std::nullopt;
    const mcap::MessageView& view = **next;
    return Event{{without_slash(view.channel->topic), mcap::to_time(view.message.log_time),
                  view.message.data.copy()},
                 is_output(*view.channel)};
  }
}

void RecordedEvents::advance() {
  batch_.clear();
  before_batch_.clear();
  std::optional<Time> time;  // of what before_batch_ counts
  while (next_) {
    RecordedMessage& message = next_->message;
    if (!batch_.empty() && (next_->is_output || message.time != batch_.front().time)) return;
    if (time != message.time) before_batch_.clear();
    time = message.time;
    if (next_->is_output) {
      ++before_batch_[message.topic];
      expected_[message.topic].push_back(std::move(message));
    } else {
      batch_.push_back(std::move(message));
      ++inputs_;
    }
    next_ = read();
  }
}

std::optional<RecordedMessage> RecordedEvents::take_expected(const std::string& topic, Time time) {
  std::deque<RecordedMessage>& expected = expected_[topic];
  if (expected.empty() || expected.front().time > time) return std::nullopt;
  RecordedMessage message = std::move(expected.front());
  expected.pop_front();
  return message;
}

std::map<std::string, std::size_t> RecordedEvents::not_taken() const {
  std::map<std::string, std::size_t> counts;
  for (const auto& [topic, expected] : expected_) {
    if (!expected.empty()) counts[topic] = expected.size();
  }
  return counts;
}

}  // namespace swiftlet
