// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "components/commander/mission_inbox.hpp"
#include "estimation/basics/time.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// How a transfer goes.
struct TransferProgress {
  enum class State { kRunning, kDone, kFailed };
  State state = State::kRunning;
  std::size_t done = 0;   ///< items that are known to be on the other side
  std::size_t count = 0;  ///< 0: not known yet
  std::string reason;     ///< of kFailed
};

/// When a transfer sends again, and when it gives up.
struct TransferParams {
  Duration resend = std::chrono::milliseconds(800);  ///< without an answer
  /// Without any headway, then it has failed: an outage of ten seconds at any moment leaves as much
  /// as it takes to find each other over a bad link.
  Duration patience = std::chrono::seconds(30);
  std::size_t burst = 10;  ///< parts that are sent at once
};

/// Fetches the vehicle's mission over a link that loses, delays, repeats and reorders. Ended with a
/// mission whose checksum is right, or with the reason why there is none.
class MissionDownload {
 public:
  MissionDownload(Time begin, const TransferParams& params)
      : params_(params), news_(begin), sent_(begin - params.resend) {}

  void hear(const swiftlet_msgs::msg::MissionState& state, Time now);
  void hear(const swiftlet_msgs::msg::MissionPart& part, Time now);
  /// What to ask the vehicle for now. To be called some times a second.
  std::optional<swiftlet_msgs::msg::MissionFetch> advance(Time now);

  const TransferProgress& progress() const { return progress_; }
  /// It failed because the vehicle has no mission.
  bool nothing_there() const { return nothing_there_; }
  /// Of kDone.
  const MissionInbox::Items& items() const { return items_; }
  const std::string& id() const { return id_; }

 private:
  void fail(const std::string& reason);

  TransferParams params_;
  Time news_, sent_;
  std::string id_;  // of the mission that is fetched
  bool is_known_ = false;
  bool nothing_there_ = false;
  MissionInbox inbox_;
  MissionInbox::Items items_;
  TransferProgress progress_;
};

/// Brings a mission to the vehicle over such a link, and reads it back. The vehicle takes a mission
/// as a whole or not at all; done is what came back as it was sent.
class MissionUpload {
 public:
  /// `id` names the upload; the same id with the same items is the same upload.
  MissionUpload(const std::string& id, MissionInbox::Items items, Time begin,
                const TransferParams& params);

  void hear(const swiftlet_msgs::msg::MissionState& state, Time now);
  void hear(const swiftlet_msgs::msg::MissionPart& part, Time now);
  struct Outgoing {
    std::vector<swiftlet_msgs::msg::MissionPart> parts;
    std::optional<swiftlet_msgs::msg::MissionFetch> fetch;
  };
  /// What to send now. To be called some times a second.
  Outgoing advance(Time now);

  const TransferProgress& progress() const { return progress_; }

 private:
  void queue(const std::vector<std::uint32_t>& indices, Time now);
  std::vector<std::uint32_t> all() const;
  void fail(const std::string& reason);

  std::string id_;
  MissionInbox::Items items_;
  std::uint32_t checksum_;
  TransferParams params_;
  Time news_, sent_;
  bool is_heard_ = false;  // the vehicle has told something
  std::deque<swiftlet_msgs::msg::MissionPart> queue_;
  std::optional<MissionDownload> reading_back_;
  TransferProgress progress_;
};

}  // namespace swiftlet
