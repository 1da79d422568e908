// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/transfer/mission_transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "components/commander/mission_message.hpp"

namespace swiftlet {
namespace {

/// In one request.
constexpr std::size_t kMostAskedFor = 80;

}  // namespace

void MissionDownload::fail(const std::string& reason) {
  if (progress_.state != TransferProgress::State::kRunning) return;
  progress_.state = TransferProgress::State::kFailed;
  progress_.reason = reason;
}

void MissionDownload::hear(const swiftlet_msgs::msg::MissionState& state, Time now) {
  if (progress_.state != TransferProgress::State::kRunning) return;
  if (state.count() == 0) {
    nothing_there_ = true;
    return fail("the vehicle has no mission");
  }
  if (is_known_ && state.id() == id_) return;
  news_ = now;
  // Another one than before: what is here of that is of no use.
  id_ = state.id();
  is_known_ = true;
  inbox_ = MissionInbox();
  progress_.done = 0;
  progress_.count = state.count();
}

void MissionDownload::hear(const swiftlet_msgs::msg::MissionPart& part, Time now) {
  if (progress_.state != TransferProgress::State::kRunning || !is_known_ || part.id() != id_) {
    return;
  }
  const Status added = inbox_.add(part);
  if (!added.ok()) return fail(added.error().reason);
  const std::size_t before =
      std::exchange(progress_.done, part.count() - inbox_.missing(part.count()).size());
  if (progress_.done > before) news_ = now;
  progress_.count = part.count();
  if (!inbox_.is_complete()) return;
  auto mission = inbox_.mission();
  if (!mission.ok()) return fail(mission.error().reason);
  items_ = std::move(*mission);
  progress_.state = TransferProgress::State::kDone;
}

std::optional<swiftlet_msgs::msg::MissionFetch> MissionDownload::advance(Time now) {
  if (progress_.state != TransferProgress::State::kRunning) return std::nullopt;
  if (now - news_ > params_.patience) {
    fail(is_known_ ? fmt::format("nothing more was heard of the mission for {:.0f} s",
                                 to_seconds(params_.patience))
                   : "no vehicle says what mission it has; does a commander run there?");
    return std::nullopt;
  }
  if (!is_known_ || now - sent_ < params_.resend) return std::nullopt;
  sent_ = now;
  swiftlet_msgs::msg::MissionFetch fetch;
  if (inbox_.id().empty()) {
    fetch.items().resize(std::min(progress_.count, kMostAskedFor));
    std::iota(fetch.items().begin(), fetch.items().end(), 0U);
  } else {
    fetch.items(inbox_.missing(kMostAskedFor));
  }
  return fetch;
}

MissionUpload::MissionUpload(const std::string& id, MissionInbox::Items items, Time begin,
                             const TransferParams& params)
    : id_(id),
      items_(std::move(items)),
      checksum_(checksum(items_)),
      params_(params),
      news_(begin),
      sent_(begin) {
  progress_.count = items_.size();
  queue(all(), begin);
}

std::vector<std::uint32_t> MissionUpload::all() const {
  std::vector<std::uint32_t> indices(items_.size());
  std::iota(indices.begin(), indices.end(), 0U);
  return indices;
}

void MissionUpload::queue(const std::vector<std::uint32_t>& indices, Time now) {
  const auto parts = make_parts(now, id_, items_, indices);
  queue_.assign(parts.begin(), parts.end());
}

void MissionUpload::fail(const std::string& reason) {
  if (progress_.state != TransferProgress::State::kRunning) return;
  progress_.state = TransferProgress::State::kFailed;
  progress_.reason = reason;
  queue_.clear();
}

void MissionUpload::hear(const swiftlet_msgs::msg::MissionState& state, Time now) {
  if (progress_.state != TransferProgress::State::kRunning) return;
  is_heard_ = true;
  if (state.upload_id() == id_ && state.upload_refused()) return fail(state.upload_reason());
  if (state.id() == id_ && state.checksum() == checksum_ && state.count() == items_.size()) {
    progress_.done = items_.size();
    queue_.clear();
    if (!reading_back_) reading_back_.emplace(now, params_);
    reading_back_->hear(state, now);
    return;
  }
  if (reading_back_) return fail("another mission was uploaded at the same time");
  if (state.upload_id() != id_) return;
  const auto& missing = state.missing();
  const std::size_t done =
      missing.size() < kMostNamedMissing ? items_.size() - missing.size() : missing.front();
  if (done > progress_.done) news_ = now;
  progress_.done = done;
  // What was sent after the vehicle looked may be on its way still.
  if (queue_.empty() && now - sent_ >= params_.resend) queue(state.missing(), now);
}

void MissionUpload::hear(const swiftlet_msgs::msg::MissionPart& part, Time now) {
  if (reading_back_) reading_back_->hear(part, now);
}

MissionUpload::Outgoing MissionUpload::advance(Time now) {
  Outgoing outgoing;
  if (progress_.state != TransferProgress::State::kRunning) return outgoing;
  if (!reading_back_ && now - news_ > params_.patience) {
    fail(is_heard_ ? "the vehicle has not confirmed the mission, and has it as a whole or not at "
                     "all; see swiftlet gcs mission status"
                   : "no vehicle says what mission it has; does a commander run there, and is "
                     "--vehicle right?");
    return outgoing;
  }
  if (reading_back_) {
    outgoing.fetch = reading_back_->advance(now);
    const TransferProgress& back = reading_back_->progress();
    if (back.state == TransferProgress::State::kFailed) {
      fail("the vehicle has the mission, but it could not be read back: " + back.reason);
    } else if (back.state == TransferProgress::State::kDone) {
      if (reading_back_->items() == items_) {
        progress_.state = TransferProgress::State::kDone;
      } else {
        fail("what was read back is not what was sent");
      }
    }
    return outgoing;
  }
  // Nothing of it has arrived, or nothing was heard of that.
  if (queue_.empty() && now - sent_ >= 3 * params_.resend) queue(all(), now);
  for (std::size_t i = 0; i < params_.burst && !queue_.empty(); ++i) {
    outgoing.parts.push_back(queue_.front());
    queue_.pop_front();
    sent_ = now;
  }
  return outgoing;
}

}  // namespace swiftlet
