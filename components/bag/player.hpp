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
  std::vector<std::string> topics;  ///< as in the recording; empty: all
  std::vector<std::string> except;  ///< as on the wire
  double rate = 1.0;                ///< of the recording's time per time
  Duration start{0};                ///< skip so much of the recording
  bool loop = false;
  bool stop_at_end = true;  ///< end the run
};

/// Publishes the messages of a recording at the times at which they were recorded. In lockstep,
/// time is that of the recording and `rate` does not matter. Messages of the same time go out in
/// the order of the file.
class Player : public Component {
 public:
  Player(const ComponentContext& context, const mcap::Reader& reader, const PlayerParams& params);

  std::size_t channels() const { return writers_.size(); }
  std::uint64_t played() const { return played_; }

 private:
  void rewind();
  void fetch();
  void play(Time now);
  Time due(Time now) const;

  PlayerParams params_;
  mcap::Reader reader_;
  std::map<std::uint16_t, std::shared_ptr<Writer>> writers_;  // by channel
  std::optional<mcap::MessageCursor> cursor_;
  std::optional<mcap::MessageView> next_;
  std::optional<Time> origin_;  // of this run: when the first message is due
  Time first_{};                // of the recording
  std::uint64_t played_ = 0;
};

/// The quality of service that a channel's `offered_qos_profiles` asks for; that of states where it
/// says nothing.
QosProfile qos_of(const mcap::Channel& channel);

}  // namespace swiftlet
