// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/replay/replay_components.hpp"

#include <fmt/format.h>

#include "components/bag/player.hpp"
#include "components/bag/topic_selection.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/reflection/first_difference.hpp"

namespace swiftlet {

using namespace std::chrono_literals;

namespace {

/// After the last input, so that periodic work sees the end before the run is over.
constexpr Duration kAfterEnd = 1s;

}  // namespace

ReplaySource::ReplaySource(const ComponentContext& context, const Recording& recording,
                           std::shared_ptr<ReplayState> state)
    : Component(context), state_(std::move(state)) {
  for (const auto& [id, channel] : recording.channels()) {
    const std::string topic = without_slash(channel.topic);
    if (state_->events.is_output(channel) || writers_.count(topic) != 0) continue;
    const auto schema = recording.schemas().find(channel.schema_id);
    if (channel.message_encoding != "cdr" || schema == recording.schemas().end()) {
      log()->warn("topic '{}' is not played: it is not CDR of a named type", topic);
    } else if (const Status name = check_name(topic); !name.ok()) {
      log()->warn("topic '{}' is not played: {}", topic, name.error().reason);
    } else {
      writers_[topic] = advertise_raw(wire_topic(context.vehicle, topic),
                                      dds_type_name(schema->second.name), qos_of(channel));
    }
  }
  context.executor->set_event_source(*this);
}

std::optional<Time> ReplaySource::next() const {
  const auto& batch = state_->events.batch();
  if (batch.empty()) return std::nullopt;
  return batch.front().time;
}

bool ReplaySource::before_timers() const {
  for (const auto& [topic, count] : state_->events.outputs_before_batch()) {
    const auto produced = state_->produced.find(topic);
    const bool all_there =
        state_->time == next() && produced != state_->produced.end() && produced->second >= count;
    if (!all_there) return false;
  }
  return true;
}

void ReplaySource::happen() {
  for (const RecordedMessage& message : state_->events.batch()) {
    const auto writer = writers_.find(message.topic);
    if (writer != writers_.end()) writer->second->write(message.cdr);
  }
  state_->events.advance();
  if (!next()) {
    call_at(now() + kAfterEnd, [this](Time) { stop(0); });
  }
}

ReplayComparison::ReplayComparison(const ComponentContext& context,
                                   std::shared_ptr<ReplayState> state,
                                   const std::map<std::string, std::string>& outputs,
                                   const std::string& source)
    : Component(context), state_(std::move(state)), source_(source) {
  for (const auto& [topic, type] : outputs) {
    QosProfile qos = qos::sensor;  // the least: every writer offers it
    qos.depth = 1000;
    subscribe_raw(wire_topic(context.vehicle, topic), type, qos,
                  [this, topic = topic, type = type](const Cdr& cdr, const SampleOrigin& origin) {
                    if (!is_from_source(origin.writer)) take(topic, type, cdr);
                  });
  }
}

bool ReplayComparison::is_from_source(const EndpointGuid& writer) {
  const auto known = from_source_.find(writer);
  if (known != from_source_.end()) return known->second;
  const std::string component = context().participant->graph().component_of(endpoint_id(writer));
  return from_source_.emplace(writer, component == source_).first->second;
}

void ReplayComparison::take(const std::string& topic, const std::string& type, const Cdr& cdr) {
  if (state_->time != now()) {
    state_->time = now();
    state_->produced.clear();
  }
  ++state_->produced[topic];
  // A recording ends in the middle of a moment.
  auto expected = state_->events.take_expected(topic, now());
  if (!expected && now() >= state_->events.end()) return;
  const auto add_to_hash = [this](const void* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      hash_ = (hash_ ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001b3ULL;
    }
  };
  const std::int64_t nanoseconds = now().time_since_epoch().count();
  add_to_hash(topic.data(), topic.size());
  add_to_hash(&nanoseconds, sizeof(nanoseconds));
  add_to_hash(cdr.data(), cdr.size());

  for (; expected && expected->time < now();
       expected = state_->events.take_expected(topic, now())) {
    note({expected->time, topic, "", "a message", "none"});
  }
  if (!expected) return note({now(), topic, "", "none", "a message"});
  ++result_.compared;
  if (expected->cdr == cdr) return;
  const TypeDescription* known = TypeLibrary::built_in().find(type);
  if (known == nullptr) return note({now(), topic, "the bytes", "others", "of an unknown type"});
  const auto difference = first_difference(*known, expected->cdr, cdr);
  if (!difference.ok()) {
    note({now(), topic, "the bytes", "", difference.error().reason});
  } else if (*difference) {
    note({now(), topic, (*difference)->field, (*difference)->a, (*difference)->b});
  }
}

void ReplayComparison::note(const ReplayDifference& difference) {
  if (!result_.first) result_.first = difference;
  ++result_.different;
  ++result_.different_by_topic[difference.topic];
}

ReplayResult ReplayComparison::result() const {
  ReplayResult result = result_;
  result.hash = fmt::format("{:016x}", hash_);
  for (const auto& [topic, count] : state_->events.not_taken()) {
    result.different += count;
    result.different_by_topic[topic] += count;
    if (!result.first) {
      result.first =
          ReplayDifference{now(), topic, "", fmt::format("{} more messages", count), "none"};
    }
  }
  return result;
}

}  // namespace swiftlet
