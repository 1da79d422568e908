// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "gcs/mission/mission_file.hpp"
#include "gcs/transfer/mission_transfer.hpp"

namespace swiftlet::screen {

/// A mission on its way to the vehicle, to be started there, or from it. One at a time. Messages go
/// in and out; it knows no topics and no clock.
class MissionErrand {
 public:
  explicit MissionErrand(const TransferParams& params) : params_(params) {}
  MissionErrand() : MissionErrand(TransferParams{}) {}

  /// `id` names the upload, and must be another one each time.
  void bring(const std::string& id, const MissionFile& mission, Time now);
  void fetch(Time now);
  /// Nothing more is sent. The vehicle takes a mission as a whole or not at all.
  void give_up();
  bool brings() const { return upload_.has_value(); }
  bool busy() const { return upload_ || download_; }

  void hear(const swiftlet_msgs::msg::MissionState& state, Time now);
  void hear(const swiftlet_msgs::msg::MissionPart& part, Time now);

  struct Outcome {
    bool ok = false;
    std::string text;                    ///< what became of it, in a sentence
    std::optional<MissionFile> fetched;  ///< of the vehicle
  };
  struct Step {
    MissionUpload::Outgoing outgoing;  ///< to be sent
    std::string progress;              ///< while it is under way
    std::optional<Outcome> outcome;    ///< once, at its end
  };
  /// To be called some times a second.
  Step advance(Time now);

 private:
  Step advance_upload(Time now);
  Step advance_download(Time now);

  TransferParams params_;
  std::optional<MissionUpload> upload_;
  std::optional<MissionDownload> download_;
};

}  // namespace swiftlet::screen
