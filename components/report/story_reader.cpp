// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/story_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "components/bag/recording_records.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/report/decision_reader.hpp"
#include "components/report/health_reader.hpp"
#include "components/report/motion_reader.hpp"
#include "components/report/vehicle_topics.hpp"
#include "components/runtime/stamp.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

constexpr double kNanosecond = 1e-9;
/// A header's time that is further from when the message was recorded is of another clock [s].
constexpr double kSameClock = 1.0;
/// Shorter silences of a sensor are no event: a busy computer has them [s].
constexpr double kSilenceWorthALine = 0.1;

/// The message's own time, where it has a header.
template <class T>
auto stamp_of(const T& message, int) -> decltype(message.header().stamp(), std::optional<Time>()) {
  return from_msg(message.header().stamp());
}
template <class T>
std::optional<Time> stamp_of(const T&, long) {
  return std::nullopt;
}

/// One pass over a recording.
class StoryReader {
 public:
  StoryReader(const Recording& recording, std::string vehicle)
      : recording_(recording),
        vehicle_(std::move(vehicle)),
        begin_(recording.statistics().message_start_time),
        duration_(kNanosecond *
                  static_cast<double>(recording.statistics().message_end_time - begin_)),
        story_(duration_),
        motion_(story_),
        health_(story_, duration_) {
    listen();
  }

  FlightStory read() {
    note_facts();
    auto cursor = recording_.messages();
    std::uint64_t damaged = 0;
    for (;;) {
      const auto next = cursor.next();
      if (!next.ok()) {
        if (++damaged <= kMostDamage) remark(next.error().reason);
        continue;
      }
      if (!*next) break;
      on_message(**next);
    }
    if (damaged > kMostDamage) remark(fmt::format("{} chunks are damaged in all", damaged));
    finish();
    return std::move(story_);
  }

 private:
  /// Reads the bytes of one message at a time [s]; false where they are not of the topic's type.
  struct Listener {
    std::string type;
    std::function<bool(double, const Cdr&)> read;
  };
  static constexpr std::uint64_t kMostDamage = 20;

  template <class T, class Handler>
  void on(const Topic<T>& topic, Handler handler) {
    const auto read = [this, handler](double logged, const Cdr& cdr) {
      const Result<T> message = from_cdr<T>(cdr);
      if (message.ok()) handler(moment(stamp_of(*message, 0), logged), *message);
      return message.ok();
    };
    listeners_[topic.name] = {message_type<T>().name(), read};
  }

  void listen() {
    on(topic::odometry, [this](double t, const auto& message) {
      motion_.on_odometry(t, message, decisions_.phase());
    });
    on(topic::setpoint, [this](double t, const auto& message) {
      motion_.on_setpoint(t, message, decisions_.phase());
    });
    on(topic::guard_setpoint, [this](double t, const auto& message) {
      motion_.on_guard_setpoint(t, message, decisions_.phase());
    });
    on(topic::sim_truth,
       [this](double t, const auto& message) { motion_.on_truth(t, message, decisions_.phase()); });
    on(topic::vehicle_status, [this](double t, const auto& message) {
      decisions_.on_status(t, message, motion_.best_position());
    });
    on(topic::guard_status, [this](double t, const auto& message) {
      decisions_.on_guard(t, message, motion_.best_position());
    });
    on(topic::mode, [this](double t, const auto& m) { decisions_.on_command(t, m); });
    on(topic::mode_ack, [this](double t, const auto& m) { decisions_.on_ack(t, m); });
    on(topic::waypoints, [this](double t, const auto& m) { decisions_.on_mission(t, m); });
    on(topic::mission_state, [this](double t, const auto& m) { decisions_.on_uploaded(t, m); });
    on(topic::goal, [this](double t, const auto& m) { decisions_.on_goal(t, m); });
    on(topic::trajectory, [this](double t, const auto& m) { decisions_.on_trajectory(t, m); });
    on(topic::exploration, [this](double t, const auto& m) { decisions_.on_exploration(t, m); });
    on(topic::battery, [this](double t, const auto& m) { health_.on_battery(t, m); });
    on(topic::diagnostics, [this](double t, const auto& m) { health_.on_diagnostics(t, m); });
    on(topic::component_status, [this](double t, const auto& m) { health_.on_component(t, m); });
    // Only the last is drawn, so only that one is read.
    listeners_[topic::map.name] = {message_type<nav_msgs::msg::OccupancyGrid>().name(),
                                   [this](double t, const Cdr& cdr) {
                                     last_map_ = {t, cdr};
                                     return true;
                                   }};
  }

  double since_begin(mcap::Timestamp time) const {
    return kNanosecond * (time >= begin_ ? static_cast<double>(time - begin_)
                                         : -static_cast<double>(begin_ - time));
  }

  double moment(const std::optional<Time>& stamp, double logged) const {
    if (!stamp) return logged;
    const double stamped = to_seconds(*stamp - mcap::to_time(begin_));
    return std::abs(stamped - logged) <= kSameClock ? stamped : logged;
  }

  void on_message(const mcap::MessageView& view) {
    const auto topic = topic_of_vehicle(view.channel->topic, vehicle_);
    if (!topic) return;
    const std::string type = view.schema == nullptr ? "" : view.schema->name;
    const double logged = since_begin(view.message.log_time);
    TopicWatch& watch = watches_.try_emplace(*topic, *topic, type).first->second;
    const auto silence = watch.add(logged);
    if (silence && *silence >= kSilenceWorthALine) note_silence(*topic, logged, *silence);
    const auto listener = listeners_.find(*topic);
    if (listener == listeners_.end()) return;
    const bool readable = view.channel->message_encoding == "cdr" &&
                          type == listener->second.type &&
                          listener->second.read(logged, view.message.data.copy());
    if (!readable) watch.add_unreadable();
  }

  void note_silence(const std::string& topic, double until, double length) {
    if (!promise_of(topic).is_sensor) return;
    story_.events.add(until, FlightEvent::Level::kWarning, "sensor",
                      fmt::format("{}: was silent for {:.2f} s until now", topic, length));
  }

  void remark(std::string text) { story_.recording.remarks.push_back(std::move(text)); }

  void note_facts() {
    RecordingFacts& facts = story_.recording;
    facts.name = recording_.name();
    for (const mcap::Reader& file : recording_.files()) {
      facts.files.push_back(file.name());
      facts.bytes += file.size();
    }
    facts.messages = recording_.statistics().message_count;
    facts.begin = begin_;
    facts.duration = duration_;
    facts.finished = recording_.finished();
    facts.vehicle = vehicle_;
    if (const auto run = metadata_named(recording_, kRunRecord)) facts.run = run->metadata;
    for (const Error& error : recording_.damage()) remark(error.reason);
    for (const std::string& missing : missing_parts(recording_)) remark(missing);
    for (const auto& [id, channel] : recording_.channels()) {
      const auto topic = topic_of_vehicle(channel.topic, vehicle_);
      if (!topic) continue;
      const auto schema = recording_.schemas().find(channel.schema_id);
      const std::string type = schema == recording_.schemas().end() ? "" : schema->second.name;
      watches_.try_emplace(*topic, *topic, type);
      const auto& counts = recording_.statistics().channel_message_counts;
      const auto count = counts.find(id);
      if (*topic == topic::vehicle_status.name && count != counts.end() && count->second > 0) {
        decisions_.expect_modes();
      }
    }
  }

  void finish() {
    motion_.finish();
    decisions_.finish();
    read_map();
    const auto ledger = losses_of(recording_);
    story_.recording.has_ledger = ledger.has_value();
    for (const auto& [topic, watch] : watches_) {
      TopicHealth health = watch.finish(duration_);
      for (const auto& [name, loss] : ledger.value_or(LossLedger())) {
        if (topic_of_vehicle(name, vehicle_) == topic) health.loss = loss;
      }
      note_unreadable(health);
      story_.topics.push_back(std::move(health));
    }
  }

  void note_unreadable(const TopicHealth& health) {
    if (health.unreadable == 0) return;
    const std::string& wanted = listeners_.at(health.topic).type;
    const std::string why =
        health.type == wanted ? fmt::format("they are no {} as this version has it", wanted)
                              : fmt::format("they are to be {} in CDR and are {}", wanted,
                                            health.type.empty() ? "of no known type" : health.type);
    remark(fmt::format("{}: {} of {} messages cannot be read and are left out: {}", health.topic,
                       health.unreadable, health.messages, why));
  }

  void read_map() {
    if (!last_map_) return;
    const auto message = from_cdr<nav_msgs::msg::OccupancyGrid>(last_map_->second);
    OccupancyGrid grid = message.ok() ? swiftlet::from_msg(*message, {}) : OccupancyGrid();
    if (grid.empty()) {
      remark(fmt::format("{}: the last message is no map that can be drawn{}", topic::map.name,
                         message.ok() ? "" : ": " + message.error().reason));
      return;
    }
    story_.map.grid_time = last_map_->first;
    story_.map.grid = std::move(grid);
  }

  const Recording& recording_;
  std::string vehicle_;
  mcap::Timestamp begin_;
  double duration_;
  FlightStory story_;
  MotionReader motion_;
  DecisionReader decisions_{story_};
  HealthReader health_;
  std::map<std::string, Listener> listeners_;
  std::map<std::string, TopicWatch> watches_;
  std::optional<std::pair<double, Cdr>> last_map_;
};

}  // namespace

Result<FlightStory> read_story(const Recording& recording, const std::string& vehicle) {
  if (recording.statistics().message_count == 0) {
    return Error{recording.name() + ": holds no message, so there is nothing to report"};
  }
  const auto chosen = vehicle_of(recording, vehicle);
  if (!chosen.ok()) return chosen.error();
  return StoryReader(recording, *chosen).read();
}

}  // namespace swiftlet
