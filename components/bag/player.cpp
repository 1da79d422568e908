// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/player.hpp"

#include <algorithm>

#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

Player::Player(const ComponentContext& context, const mcap::Reader& reader,
               const PlayerParams& params)
    : Component(context), params_(params), reader_(reader) {
  for (const auto& [id, channel] : reader_.channels()) {
    const auto schema = reader_.schemas().find(channel.schema_id);
    const std::string topic = channel.topic[0] == '/' ? channel.topic.substr(1) : channel.topic;
    const std::string wire = wire_topic(context.vehicle, topic);
    const bool wanted = params_.topics.empty() || contains(params_.topics, channel.topic);
    if (!wanted || contains(params_.except, wire)) continue;
    if (channel.message_encoding != "cdr" || schema == reader_.schemas().end()) {
      log()->warn("topic '{}' is not played: it is not CDR of a known type", channel.topic);
      continue;
    }
    writers_[id] = advertise_raw(wire, dds_type_name(schema->second.name), qos_of(channel));
  }
  if (writers_.empty()) return;
  first_ = mcap::to_time(reader_.statistics().message_start_time) + params_.start;
  rewind();
  call_at(now(), [this](Time now) { play(now); });
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
      log()->warn("{}", next.error().reason);  // one chunk is lost, the others are played
      continue;
    }
    next_ = *next;
    if (!next_ || writers_.count(next_->channel->id) != 0) return;
  }
}

Time Player::due(Time now) const {
  const double elapsed = to_seconds(mcap::to_time(next_->message.log_time) - first_);
  if (params_.rate == 1.0) {
    return *origin_ + (mcap::to_time(next_->message.log_time) - first_);
  }
  return std::max(now, *origin_ + from_seconds(elapsed / params_.rate));
}

void Player::play(Time now) {
  if (!origin_) origin_ = now;
  while (next_ && due(now) <= now) {
    const mcap::ByteView data = next_->message.data;
    writers_[next_->channel->id]->write(Cdr(data.data, data.data + data.size));
    ++played_;
    fetch();
    if (next_ && due(now) == now) {
      // What the last one set off goes first, as when it was recorded.
      break;
    }
  }
  if (next_) {
    call_at(due(now), [this](Time later) { play(later); });
  } else if (params_.loop) {
    rewind();
    call_at(now, [this](Time later) { play(later); });
  } else if (params_.stop_at_end) {
    // Let periodic work see the end of the recording before the run is over.
    call_at(now + std::chrono::seconds(1), [this](Time) { stop(0); });
  }
}

QosProfile qos_of(const mcap::Channel& channel) {
  QosProfile qos = qos::state;
  const auto metadata = channel.metadata.find("offered_qos_profiles");
  if (metadata == channel.metadata.end()) return qos;
  const std::string& text = metadata->second;
  if (text.find("reliability: 2") != std::string::npos) qos = qos::sensor;
  if (text.find("durability: 1") != std::string::npos) qos = qos::map;
  return qos;
}

}  // namespace swiftlet
