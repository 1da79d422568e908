// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "components/commander/mission_inbox.hpp"
#include "control/mission_runner.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// The vehicle's mission as ground stations see it: takes uploads, hands it out, says how far it
/// is, and passes on to a MissionRunner what it is told.
///
/// An upload is taken as a whole or not at all: the mission that there was stays until every item
/// of the new one is here, its checksum is right, and the runner accepts it.
class MissionDesk {
 public:
  explicit MissionDesk(const MissionRunner::Params& params)
      : runner_(params), inbox_(params.most_items) {}

  void set_params(const MissionRunner::Params& params) { runner_.set_params(params); }
  void hear(const swiftlet_msgs::msg::MissionPart& part, const FlightDirector& director, Time now);
  /// An upload of who may not. One that is under way is not disturbed: then nothing is said yet.
  void refuse(const swiftlet_msgs::msg::MissionPart& part, const std::string& reason, Time now);
  std::vector<swiftlet_msgs::msg::MissionPart> answer(const swiftlet_msgs::msg::MissionFetch& fetch,
                                                      Time now) const;
  void hear(const swiftlet_msgs::msg::ClawState& claw, Time now);

  /// Carries out what is about the mission or the claw; nothing where it is another command.
  std::optional<Result<Acceptance>> carry_out(const swiftlet_msgs::msg::ModeCommand& command,
                                              FlightDirector& director,
                                              const std::optional<LocalOrigin>& origin, Time now);
  void tick(FlightDirector& director, const std::optional<LocalOrigin>& origin, Time now) {
    runner_.tick(director, origin, now);
  }

  swiftlet_msgs::msg::MissionState state(Time now) const;
  /// Of the upload that the mission came with; "" where there is none.
  const std::string& id() const { return id_; }
  /// What the claw shall be; nothing before it was told the first time.
  std::optional<bool> claw_open() const { return runner_.memory().claw_open; }

  /// For a standby: the mission as one part, and what the runner remembers.
  swiftlet_msgs::msg::MissionPart whole(Time now) const;
  void restore(const swiftlet_msgs::msg::MissionPart& whole);
  void write(swiftlet_msgs::msg::CommanderState& state) const;
  void restore(const swiftlet_msgs::msg::CommanderState& state);

 private:
  Status take(const FlightDirector& director);
  bool uploads() const;  // some of the last upload is missing
  Time part_heard_{};    // of it, last
  void end_upload();
  MissionInbox::Items messages() const;

  MissionRunner runner_;
  MissionInbox inbox_;
  std::string id_;  // of the upload that the mission came with
  std::uint32_t checksum_ = 0;
  std::deque<std::string> ended_;  // uploads
  std::string upload_;             // the last
  std::string refusal_;            // of the last upload, where it was refused
  std::optional<Time> claw_heard_;
};

/// Whether a standby should hear of the change.
bool differs(const swiftlet_msgs::msg::MissionState& a, const swiftlet_msgs::msg::MissionState& b);

}  // namespace swiftlet
