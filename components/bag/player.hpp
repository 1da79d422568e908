// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/recording.hpp"
#include "components/bag/topic_selection.hpp"
#include "components/runtime/component.hpp"
#include "rosgraph_msgs.h"

namespace swiftlet {

struct PlayerParams {
  std::vector<std::string> topics;  ///< as in TopicPatterns, by recorded names; empty: all
  std::vector<std::string> except;  ///< as on the wire
  double rate = 1.0;                ///< of the recording's time per time
  Duration start{0};                ///< skip so much of the recording
  Duration delay{0};                ///< before the first message, for others to find the topics
  bool loop = false;
  bool stop_at_end = true;                     ///< end the run
  std::vector<std::string> exclude{};          ///< as in TopicPatterns, by recorded names
  std::map<std::string, std::string> remap{};  ///< new names, by recorded ones
  std::map<std::string, QosProfile> qos{};     ///< instead of the recorded one, by recorded name
  double clock_hz = 0.0;  ///< publish the time of the recording on `clock`; 0: do not
};

/// Publishes the messages of a recording as far apart in time as they were recorded, divided by
/// `rate`. A lockstep run that begins at the start of the recording has its times, to the
/// nanosecond. Messages of the same time go out in the order of the file, each after what the one
/// before has set off. Where the start is skipped, the last map, static transform and other message
/// meant for late readers (transient local) from before goes out first.
///
/// Topics that are not CDR with a known type name, or whose name DDS cannot carry, are left out
/// with a warning. A damaged chunk costs its own messages.
class Player : public Component {
 public:
  Player(const ComponentContext& context, const Recording& recording, const PlayerParams& params);

  std::size_t topics() const { return by_topic_.size(); }
  std::uint64_t played() const { return played_; }
  /// Chunks that could not be read.
  std::uint64_t damaged_chunks() const { return damaged_chunks_; }

  // Wishes of somebody who watches, from any thread. They are heard at the next moment.
  void pause_or_resume();
  /// The next message now, then pause.
  void step();
  /// Forward or back, as with `start`.
  void seek(Duration by);
  /// Faster or slower.
  void scale_rate(double factor);

  /// How it goes. From any thread.
  struct Progress {
    Duration position{0};  ///< from the start of the recording
    Duration length{0};    ///< of the recording
    double rate = 1.0;
    bool paused = false;
    std::uint64_t played = 0;
  };
  Progress progress() const;

 private:
  /// How the recording's time follows the run's.
  struct Pace {
    Time run{};        // at which
    Time recording{};  // this time of the recording is due
    double rate = 1.0;
    bool paused = false;

    Time due(Time recorded) const;
    Time position(Time now) const;
  };
  /// Wakes the component for a wish.
  class Wishes : public Task {
   public:
    explicit Wishes(Player& player) : player_(player) {}
    void add(std::function<void()> wish);
    void run() override;

   private:
    Player& player_;
    std::mutex mutex_;
    std::deque<std::function<void()>> wishes_;
  };

  void offer_topics();
  void offer(const mcap::Channel& channel, const std::string& wire, const std::string& type);
  void go_to(Time position);
  void fetch();
  void play(Time now);
  /// Calls play() when the next message is due, and no more for what was scheduled before.
  void schedule(Time when);
  void play_latched();
  void publish(const mcap::MessageView& view);
  void publish_clock(Time now);
  void begin(Time now);
  Pace pace() const;
  void set_pace(const Pace& pace);
  Time position(Time now) const;

  PlayerParams params_;
  TopicSelection selection_;
  Recording recording_;
  Wishes wishes_{*this};
  std::map<std::uint16_t, std::shared_ptr<Writer>> writers_;  // by channel
  std::map<std::string, std::shared_ptr<Writer>> by_topic_;   // the same by topic on the wire
  std::map<std::string, std::string> types_;                  // by topic, both as on the wire
  std::map<std::string, int> latched_;  // depth of topics for late readers, by recorded name
  Publisher<rosgraph_msgs::msg::Clock> clock_;
  std::optional<RecordingCursor> cursor_;
  std::optional<mcap::MessageView> next_;
  bool begun_ = false;
  std::uint64_t schedule_ = 0;  // which of those that were made is to be kept
  Time first_{};                // of the recording, from which is played
  Time begin_{};                // of the recording
  Time end_{};                  // of the recording
  mutable std::mutex pace_mutex_;
  Pace pace_;
  std::atomic<std::uint64_t> played_{0};
  std::uint64_t damaged_chunks_ = 0;
};

/// The quality of service that a channel's `offered_qos_profiles` asks for, in any of rosbag2's
/// spellings; of several writers the weakest. That of states where it says nothing.
QosProfile qos_of(const mcap::Channel& channel);

}  // namespace swiftlet
