// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/mcap/reader.hpp"
#include "components/runtime/component.hpp"

namespace swiftlet {

struct PlayerParams {
  std::vector<std::string> topics;  ///< as in the recording, leading '/' or not; empty: all
  std::vector<std::string> except;  ///< as on the wire
  double rate = 1.0;                ///< of the recording's time per time
  Duration start{0};                ///< skip so much of the recording
  Duration delay{0};                ///< before the first message, for others to find the topics
  bool loop = false;
  bool stop_at_end = true;  ///< end the run
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
  Player(const ComponentContext& context, const mcap::Reader& reader, const PlayerParams& params);

  std::size_t channels() const { return writers_.size(); }
  std::uint64_t played() const { return played_; }
  /// Chunks that could not be read.
  std::uint64_t damaged_chunks() const { return damaged_chunks_; }

 private:
  void offer(const mcap::Channel& channel, const std::string& wire, const std::string& type);
  void rewind();
  void fetch();
  void play(Time now);
  void play_latched();
  void publish(const mcap::MessageView& view);
  Time due(Time now) const;

  PlayerParams params_;
  mcap::Reader reader_;
  std::map<std::uint16_t, std::shared_ptr<Writer>> writers_;  // by channel
  std::map<std::string, std::string> types_;                  // by topic, both as on the wire
  std::vector<std::string> latched_;                          // topics for late readers
  std::optional<mcap::MessageCursor> cursor_;
  std::optional<mcap::MessageView> next_;
  std::optional<Time> origin_;  // of this run: when the recording's first_ is due
  Time first_{};                // of the recording
  std::uint64_t played_ = 0;
  std::uint64_t damaged_chunks_ = 0;
};

/// The quality of service that a channel's `offered_qos_profiles` asks for, in any of rosbag2's
/// spellings; of several writers the weakest. That of states where it says nothing.
QosProfile qos_of(const mcap::Channel& channel);

}  // namespace swiftlet
