// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "components/topics.hpp"
#include "gcs/transfer/mission_transfer.hpp"

namespace swiftlet {

/// Told of the progress of a transfer when it changes.
using TellProgress = std::function<void(const TransferProgress&)>;

/// Brings a mission to the vehicle, then ends the run: 0 once it was read back, else 1.
class UploadClient : public Component {
 public:
  UploadClient(const ComponentContext& context, const std::string& station, const std::string& id,
               MissionInbox::Items items, const TransferParams& params, TellProgress tell);
  const TransferProgress& progress() const { return upload_.progress(); }

 private:
  void advance(Time now);

  std::string station_;
  MissionUpload upload_;
  TellProgress tell_;
  Publisher<swiftlet_msgs::msg::MissionPart> parts_;
  Publisher<swiftlet_msgs::msg::MissionFetch> fetch_;
};

/// Fetches the vehicle's mission, then ends the run: 0 once it is here, else 1.
class DownloadClient : public Component {
 public:
  DownloadClient(const ComponentContext& context, const TransferParams& params, TellProgress tell);
  const MissionDownload& download() const { return download_; }

 private:
  void advance(Time now);

  MissionDownload download_;
  TellProgress tell_;
  Publisher<swiftlet_msgs::msg::MissionFetch> fetch_;
};

}  // namespace swiftlet
