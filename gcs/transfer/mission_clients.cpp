// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/transfer/mission_clients.hpp"

#include <utility>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 100ms;

int exit_code(const TransferProgress& progress) {
  return progress.state == TransferProgress::State::kDone ? 0 : 1;
}

}  // namespace

UploadClient::UploadClient(const ComponentContext& context, const std::string& station,
                           const std::string& id, MissionInbox::Items items,
                           const TransferParams& params, TellProgress tell)
    : Component(context),
      station_(station),
      upload_(id, std::move(items), now(), params),
      tell_(std::move(tell)) {
  parts_ = advertise(topic::mission_upload);
  fetch_ = advertise(topic::mission_fetch);
  subscribe(topic::mission_state,
            [this](const swiftlet_msgs::msg::MissionState& state) { upload_.hear(state, now()); });
  subscribe(
      topic::mission_download,
      [this](const swiftlet_msgs::msg::MissionPart& part) { upload_.hear(part, now()); },
      Need::kOptional);
  every(kTick, [this](Time now) { advance(now); });
}

void UploadClient::advance(Time now) {
  MissionUpload::Outgoing outgoing = upload_.advance(now);
  for (auto& part : outgoing.parts) {
    part.station(station_);
    parts_.publish(part);
  }
  if (outgoing.fetch) fetch_.publish(*outgoing.fetch);
  tell_(upload_.progress());
  if (upload_.progress().state != TransferProgress::State::kRunning) {
    stop(exit_code(upload_.progress()));
  }
}

DownloadClient::DownloadClient(const ComponentContext& context, const TransferParams& params,
                               TellProgress tell)
    : Component(context), download_(now(), params), tell_(std::move(tell)) {
  fetch_ = advertise(topic::mission_fetch);
  subscribe(topic::mission_state, [this](const swiftlet_msgs::msg::MissionState& state) {
    download_.hear(state, now());
  });
  subscribe(
      topic::mission_download,
      [this](const swiftlet_msgs::msg::MissionPart& part) { download_.hear(part, now()); },
      Need::kOptional);
  every(kTick, [this](Time now) { advance(now); });
}

void DownloadClient::advance(Time now) {
  if (const auto fetch = download_.advance(now)) fetch_.publish(*fetch);
  tell_(download_.progress());
  if (download_.progress().state != TransferProgress::State::kRunning) {
    stop(exit_code(download_.progress()));
  }
}

}  // namespace swiftlet
