// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/player.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Between the rounds of a loop: time must pass even where the recording has none.
constexpr Duration kLoopPause = 1ms;
/// After the last message, so that periodic work sees the end before the run is over.
constexpr Duration kAfterEnd = 1s;
constexpr int kMaxDepth = 1000;

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// Names in rosbag2 files begin with a slash, ours do not.
std::string without_slash(const std::string& topic) {
  return !topic.empty() && topic[0] == '/' ? topic.substr(1) : topic;
}

}  // namespace

Player::Player(const ComponentContext& context, const mcap::Reader& reader,
               const PlayerParams& params)
    : Component(context), params_(params), reader_(reader) {
  for (std::string& topic : params_.topics) topic = without_slash(topic);
  for (const auto& [id, channel] : reader_.channels()) {
    const std::string topic = without_slash(channel.topic);
    const std::string wire = wire_topic(context.vehicle, topic);
    const bool wanted = params_.topics.empty() || contains(params_.topics, topic);
    if (!wanted || contains(params_.except, wire)) continue;
    const auto schema = reader_.schemas().find(channel.schema_id);
    if (channel.message_encoding != "cdr" || schema == reader_.schemas().end()) {
      log()->warn("topic '{}' is not played: it is not CDR of a named type", channel.topic);
    } else if (const Status name = check_name(topic); !name.ok()) {
      log()->warn("topic '{}' is not played: {}", channel.topic, name.error().reason);
    } else {
      offer(channel, wire, dds_type_name(schema->second.name));
    }
  }
  if (writers_.empty() && !params_.stop_at_end) return;
  first_ = mcap::to_time(reader_.statistics().message_start_time) + params_.start;
  rewind();
  call_at(now() + params_.delay, [this](Time now) {
    if (params_.start > Duration(0)) play_latched();
    play(now);
  });
}

void Player::offer(const mcap::Channel& channel, const std::string& wire, const std::string& type) {
  const std::string& used = types_.emplace(wire, type).first->second;
  if (used != type) {
    log()->warn("topic '{}' is not played as {}: the recording has it as {}, too", channel.topic,
                ros_type_name(type), ros_type_name(used));
    return;
  }
  const QosProfile qos = qos_of(channel);
  writers_[channel.id] = advertise_raw(wire, type, qos);
  if (qos.transient_local) latched_.push_back(channel.topic);
}

void Player::rewind() {
  mcap::Filter filter;
  filter.first = mcap::to_timestamp(first_);
  cursor_.emplace(reader_.messages(filter));
  origin_.reset();
  fetch();
}

void Player::fetch() {
  for (;;) {
    auto next = cursor_->next();
    if (!next.ok()) {
      log()->warn("{}", next.error().reason);
      ++damaged_chunks_;
      continue;
    }
    next_ = *next;
    if (!next_ || writers_.count(next_->channel->id) != 0) return;
  }
}

Time Player::due(Time now) const {
  const Duration elapsed = mcap::to_time(next_->message.log_time) - first_;
  if (params_.rate == 1.0) return *origin_ + elapsed;
  return std::max(now, *origin_ + from_seconds(to_seconds(elapsed) / params_.rate));
}

void Player::publish(const mcap::MessageView& view) {
  const mcap::ByteView data = view.message.data;
  writers_[view.channel->id]->write(data.copy());
  ++played_;
}

void Player::play_latched() {
  if (latched_.empty() || mcap::to_timestamp(first_) == 0) return;
  mcap::Filter filter;
  filter.topics = latched_;
  filter.last = mcap::to_timestamp(first_) - 1;
  std::map<std::uint16_t, Cdr> last;
  auto cursor = reader_.messages(filter);
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) continue;
    if (!*next) break;
    last[(*next)->channel->id] = (*next)->message.data.copy();
  }
  for (const auto& [channel, cdr] : last) {
    if (writers_.count(channel) != 0) writers_[channel]->write(cdr);
  }
}

void Player::play(Time now) {
  if (!origin_) origin_ = now;
  if (next_ && due(now) <= now) {
    publish(*next_);
    fetch();
  }
  if (next_) {
    // One of the same moment waits for its own timer: what the last one set off goes first, as
    // when it was recorded.
    call_at(std::max(now, due(now)), [this](Time later) { play(later); });
  } else if (params_.loop && played_ > 0) {
    rewind();
    call_at(now + kLoopPause, [this](Time later) { play(later); });
  } else if (params_.stop_at_end) {
    call_at(now + kAfterEnd, [this](Time) { stop(0); });
  }
}

QosProfile qos_of(const mcap::Channel& channel) {
  bool best_effort = false, latched = false, gone = false;
  int depth = 0;
  const auto metadata = channel.metadata.find("offered_qos_profiles");
  std::istringstream words(metadata == channel.metadata.end() ? "" : metadata->second);
  for (std::string key, value; words >> key;) {
    // Numbers are those of rmw up to Humble, words from Iron on.
    if (key == "reliability:" && words >> value) {
      best_effort = best_effort || value == "2" || value == "best_effort";
    } else if (key == "durability:" && words >> value) {
      const bool is_latched = value == "1" || value == "transient_local";
      (is_latched ? latched : gone) = true;
    } else if (key == "depth:" && words >> value) {
      depth = std::max(depth, static_cast<int>(std::clamp(std::strtol(value.c_str(), nullptr, 10),
                                                          0L, long{kMaxDepth})));
    }
  }
  QosProfile qos = qos::state;
  qos.name = "recorded";
  qos.reliable = !best_effort;
  qos.transient_local = latched && !gone;
  if (depth > 0) qos.depth = depth;
  if (depth == 0 && qos.transient_local) qos.depth = qos::map.depth;  // a writer that did not say
  qos.large = true;  // nothing says how large the samples are
  return qos;
}

}  // namespace swiftlet
