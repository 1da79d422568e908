// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/mission_errand.hpp"

#include <fmt/format.h>

#include "components/commander/mission_message.hpp"

namespace swiftlet::screen {
namespace {

using State = TransferProgress::State;

std::string progress_text(const char* what, const TransferProgress& progress) {
  if (progress.count == 0) return fmt::format("{}: looking for the vehicle", what);
  return fmt::format("{}: {} of {} items", what, progress.done, progress.count);
}

MissionErrand::Outcome failed(const char* what, const std::string& reason) {
  return {false, fmt::format("{}: {}", what, reason), std::nullopt};
}

MissionErrand::Outcome fetched(const MissionInbox::Items& messages) {
  MissionFile mission;
  for (const auto& message : messages) {
    const auto item = from_msg(message);
    if (!item.ok()) return failed("download", item.error().reason);
    mission.items.push_back({*item, 0});
  }
  const std::size_t count = mission.items.size();
  return {true, fmt::format("download: {} items", count), std::move(mission)};
}

}  // namespace

void MissionErrand::bring(const std::string& id, const MissionFile& mission, Time now) {
  MissionInbox::Items items;
  for (const MissionItem& item : items_of(mission)) items.push_back(to_msg(item));
  give_up();
  upload_.emplace(id, std::move(items), now, params_);
}

void MissionErrand::fetch(Time now) {
  give_up();
  download_.emplace(now, params_);
}

void MissionErrand::give_up() {
  upload_.reset();
  download_.reset();
}

void MissionErrand::hear(const swiftlet_msgs::msg::MissionState& state, Time now) {
  if (upload_) upload_->hear(state, now);
  if (download_) download_->hear(state, now);
}

void MissionErrand::hear(const swiftlet_msgs::msg::MissionPart& part, Time now) {
  if (upload_) upload_->hear(part, now);
  if (download_) download_->hear(part, now);
}

MissionErrand::Step MissionErrand::advance(Time now) {
  if (upload_) return advance_upload(now);
  if (download_) return advance_download(now);
  return {};
}

MissionErrand::Step MissionErrand::advance_upload(Time now) {
  Step step;
  step.outgoing = upload_->advance(now);
  const TransferProgress progress = upload_->progress();
  if (progress.state == State::kRunning) {
    step.progress = progress_text("upload", progress);
    return step;
  }
  upload_.reset();
  step.outcome =
      progress.state == State::kFailed
          ? failed("upload", progress.reason)
          : Outcome{true, fmt::format("upload: {} items, read back", progress.count), std::nullopt};
  return step;
}

MissionErrand::Step MissionErrand::advance_download(Time now) {
  Step step;
  step.outgoing.fetch = download_->advance(now);
  const TransferProgress& progress = download_->progress();
  if (progress.state == State::kRunning) {
    step.progress = progress_text("download", progress);
    return step;
  }
  step.outcome = progress.state == State::kFailed ? failed("download", progress.reason)
                                                  : fetched(download_->items());
  download_.reset();
  return step;
}

}  // namespace swiftlet::screen
