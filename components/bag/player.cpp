// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/player.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "components/conversions.hpp"
#include "components/runtime/names.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Between the rounds of a loop: time must pass even where the recording has none.
constexpr Duration kLoopPause = 1ms;
/// After the last message, so that periodic work sees the end before the run is over.
constexpr Duration kAfterEnd = 1s;
constexpr int kMaxDepth = 1000;
constexpr double kSlowest = 1e-3, kFastest = 1e3;

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

Time Player::Pace::due(Time recorded) const {
  const Duration elapsed = recorded - recording;
  return run + (rate == 1.0 ? elapsed : from_seconds(to_seconds(elapsed) / rate));
}

Time Player::Pace::position(Time now) const {
  if (paused || now <= run) return recording;
  return recording + (rate == 1.0 ? now - run : from_seconds(to_seconds(now - run) * rate));
}

void Player::Wishes::add(std::function<void()> wish) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wishes_.push_back(std::move(wish));
  }
  player_.mailbox().post(*this);
}

void Player::Wishes::run() {
  std::function<void()> wish;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wish = std::move(wishes_.front());
    wishes_.pop_front();
  }
  if (player_.begun_) wish();
}

Player::Player(const ComponentContext& context, const Recording& recording,
               const PlayerParams& params)
    : Component(context),
      params_(params),
      selection_({params.topics, {}, params.exclude}),
      recording_(recording),
      begin_(mcap::to_time(recording.statistics().message_start_time)),
      end_(mcap::to_time(recording.statistics().message_end_time)) {
  first_ = begin_ + params_.start;
  pace_.recording = first_;
  pace_.rate = params_.rate;
  pace_.paused = true;  // until it begins
  offer_topics();
  if (params_.clock_hz > 0.0) {
    clock_ = advertise(topic::clock);
    every(from_seconds(1.0 / params_.clock_hz), [this](Time now) { publish_clock(now); });
  }
  if (writers_.empty() && !params_.stop_at_end) return;
  go_to(first_);
  call_at(now() + params_.delay, [this](Time now) { begin(now); });
}

void Player::offer_topics() {
  for (const auto& [id, channel] : recording_.channels()) {
    const std::string recorded = without_slash(channel.topic);
    const auto renamed = params_.remap.find(recorded);
    const std::string topic = renamed == params_.remap.end() ? recorded : renamed->second;
    const std::string wire = wire_topic(context().vehicle, topic);
    // Of two clocks, only one can be right.
    const bool is_clock = params_.clock_hz > 0.0 && topic == topic::clock.name;
    if (!selection_.wants(recorded) || contains(params_.except, wire) || is_clock) continue;
    const auto schema = recording_.schemas().find(channel.schema_id);
    if (channel.message_encoding != "cdr" || schema == recording_.schemas().end()) {
      log()->warn("topic '{}' is not played: it is not CDR of a named type", channel.topic);
    } else if (const Status name = check_name(topic); !name.ok()) {
      log()->warn("topic '{}' is not played: {}", channel.topic, name.error().reason);
    } else {
      offer(channel, wire, dds_type_name(schema->second.name));
    }
  }
}

void Player::offer(const mcap::Channel& channel, const std::string& wire, const std::string& type) {
  const std::string& used = types_.emplace(wire, type).first->second;
  if (used != type) {
    log()->warn("topic '{}' is not played as {}: the recording has it as {}, too", channel.topic,
                ros_type_name(type), ros_type_name(used));
    return;
  }
  const auto wanted = params_.qos.find(without_slash(channel.topic));
  QosProfile qos = wanted == params_.qos.end() ? qos_of(channel) : wanted->second;
  qos.large = true;  // nothing says how large the samples are
  // Several components may have written the topic.
  std::shared_ptr<Writer>& writer = by_topic_[wire];
  if (writer == nullptr) writer = advertise_raw(wire, type, qos);
  writers_[channel.id] = writer;
  if (qos.transient_local) latched_[channel.topic] = qos.depth;
}

void Player::begin(Time now) {
  begun_ = true;
  if (params_.start > Duration(0)) play_latched();
  set_pace({now, first_, params_.rate, false});
  play(now);
}

void Player::go_to(Time position) {
  mcap::Filter filter;
  filter.first = mcap::to_timestamp(position);
  cursor_.emplace(recording_.messages(filter));
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

void Player::publish(const mcap::MessageView& view) {
  const mcap::ByteView data = view.message.data;
  writers_[view.channel->id]->write(data.copy());
  ++played_;
}

void Player::publish_clock(Time now) {
  rosgraph_msgs::msg::Clock message;
  message.clock(make_header(position(now), "").stamp());
  clock_.publish(message);
}

void Player::play_latched() {
  const mcap::Timestamp position = mcap::to_timestamp(pace().recording);
  if (latched_.empty() || position == 0) return;
  mcap::Filter filter;
  for (const auto& [topic, depth] : latched_) filter.topics.push_back(topic);
  filter.last = position - 1;
  std::map<std::uint16_t, std::deque<Cdr>> last;
  auto cursor = recording_.messages(filter);
  for (;;) {
    const auto next = cursor.next();
    if (!next.ok()) continue;
    if (!*next) break;
    std::deque<Cdr>& kept = last[(*next)->channel->id];
    kept.push_back((*next)->message.data.copy());
    const auto depth = static_cast<std::size_t>(latched_[(*next)->channel->topic]);
    if (kept.size() > depth) kept.pop_front();
  }
  for (const auto& [channel, samples] : last) {
    if (writers_.count(channel) == 0) continue;
    for (const Cdr& cdr : samples) writers_[channel]->write(cdr);
  }
}

void Player::schedule(Time when) {
  call_at(when, [this, made = ++schedule_](Time now) {
    if (made == schedule_) play(now);
  });
}

void Player::play(Time now) {
  const Pace pace = this->pace();
  if (pace.paused) return;
  if (next_ && pace.due(mcap::to_time(next_->message.log_time)) <= now) {
    publish(*next_);
    fetch();
  }
  if (next_) {
    // One of the same moment waits for its own timer: what the last one set off goes first, as
    // when it was recorded.
    schedule(std::max(now, pace.due(mcap::to_time(next_->message.log_time))));
  } else if (params_.loop && played_ > 0) {
    go_to(first_);
    set_pace({now + kLoopPause, first_, pace.rate, false});
    schedule(now + kLoopPause);
  } else if (params_.stop_at_end) {
    call_at(now + kAfterEnd, [this, made = ++schedule_](Time) {
      if (made == schedule_) stop(0);
    });
  }
}

void Player::pause_or_resume() {
  wishes_.add([this] {
    const Time now = this->now();
    set_pace({now, position(now), pace().rate, !pace().paused});
    schedule(now);
  });
}

void Player::step() {
  wishes_.add([this] {
    const Time now = this->now();
    Time reached = position(now);
    if (next_) {
      reached = mcap::to_time(next_->message.log_time);
      publish(*next_);
      fetch();
    }
    set_pace({now, reached, pace().rate, true});
  });
}

void Player::seek(Duration by) {
  wishes_.add([this, by] {
    const Time now = this->now();
    const Time target = std::clamp(position(now) + by, begin_, end_);
    set_pace({now, target, pace().rate, pace().paused});
    go_to(target);
    play_latched();
    schedule(now);
  });
}

void Player::scale_rate(double factor) {
  wishes_.add([this, factor] {
    const Time now = this->now();
    const Pace old = pace();
    set_pace({now, position(now), std::clamp(old.rate * factor, kSlowest, kFastest), old.paused});
    schedule(now);
  });
}

Player::Pace Player::pace() const {
  const std::lock_guard<std::mutex> lock(pace_mutex_);
  return pace_;
}

void Player::set_pace(const Pace& pace) {
  const std::lock_guard<std::mutex> lock(pace_mutex_);
  pace_ = pace;
}

Time Player::position(Time now) const {
  return std::min(pace().position(now), std::max(end_, first_));
}

Player::Progress Player::progress() const {
  const Pace now_pace = pace();
  return {position(now()) - begin_, end_ - begin_, now_pace.rate, now_pace.paused, played_};
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
