// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/link_outbox.hpp"

#include <algorithm>

namespace swiftlet {
namespace {

constexpr std::size_t kMostCommands = 8;
constexpr int kMostUrgentInARow = 4;

Status check_length(const LinkOutbox::Payload& payload, const char* what) {
  if (payload.size() <= kMaxPayload) return {};
  return Error{std::string(what) + " of " + std::to_string(payload.size()) +
               " bytes does not fit into a frame, which carries " + std::to_string(kMaxPayload)};
}

template <class List>
auto find_id(List& list, const std::string& id) {
  return std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.id == id; });
}

}  // namespace

Status LinkOutbox::offer_telemetry(Payload payload) {
  const Status fits = check_length(payload, "telemetry");
  if (!fits.ok()) return fits;
  if (telemetry_) ++counts_.outdated;
  telemetry_ = std::move(payload);
  return {};
}

Status LinkOutbox::offer_command(const std::string& id, Payload payload, Time now) {
  const Status fits = check_length(payload, "a command");
  if (!fits.ok()) return fits;
  const auto known = find_id(commands_, id);
  if (known != commands_.end()) {
    known->asked = now;
    return {};
  }
  if (commands_.size() >= kMostCommands) {
    commands_.erase(commands_.begin());
    ++counts_.given_up;
  }
  commands_.push_back({id, std::move(payload), now, now});
  return {};
}

Status LinkOutbox::offer_acknowledgement(const std::string& id, Payload payload) {
  const Status fits = check_length(payload, "an acknowledgement");
  if (!fits.ok()) return fits;
  const auto known = find_id(acknowledgements_, id);
  if (known != acknowledgements_.end()) {
    known->payload = std::move(payload);
    return {};
  }
  if (acknowledgements_.size() >= kMostCommands) acknowledgements_.erase(acknowledgements_.begin());
  acknowledgements_.push_back({id, std::move(payload)});
  return {};
}

void LinkOutbox::acknowledged(const std::string& id) {
  const auto known = find_id(commands_, id);
  if (known != commands_.end()) commands_.erase(known);
}

void LinkOutbox::give_up(Time now) {
  const auto is_over = [&](const Command& command) {
    return to_seconds(now - command.asked) > params_.patience;
  };
  const auto end = std::remove_if(commands_.begin(), commands_.end(), is_over);
  counts_.given_up += static_cast<std::uint64_t>(commands_.end() - end);
  commands_.erase(end, commands_.end());
}

std::optional<LinkFrame> LinkOutbox::choose_urgent(Time now) {
  if (!acknowledgements_.empty()) {
    LinkFrame frame{FrameType::kAcknowledgement, 0, std::move(acknowledgements_.front().payload)};
    acknowledgements_.erase(acknowledgements_.begin());
    return frame;
  }
  // The one that waits longest.
  const auto first = std::min_element(commands_.begin(), commands_.end(),
                                      [](const auto& a, const auto& b) { return a.due < b.due; });
  if (first == commands_.end() || first->due > now) return std::nullopt;
  first->due = now + from_seconds(params_.repeat);
  return LinkFrame{FrameType::kCommand, 0, first->payload};
}

std::optional<LinkFrame> LinkOutbox::choose(Time now) {
  if (!telemetry_ || urgent_in_a_row_ < kMostUrgentInARow) {
    if (auto urgent = choose_urgent(now)) {
      ++urgent_in_a_row_;
      return urgent;
    }
  }
  urgent_in_a_row_ = 0;
  if (telemetry_) {
    LinkFrame frame{FrameType::kTelemetry, 0, std::move(*telemetry_)};
    telemetry_.reset();
    return frame;
  }
  if (to_seconds(now - last_sent_) < params_.hello) return std::nullopt;
  return LinkFrame{};
}

std::optional<std::vector<std::uint8_t>> LinkOutbox::next(Time now) {
  give_up(now);
  if (now < free_at_) return std::nullopt;
  auto frame = choose(now);
  if (!frame) return std::nullopt;
  frame->sequence = sequence_++;
  auto bytes = encode(*frame);
  free_at_ = now + from_seconds(static_cast<double>(bytes.size()) / params_.bytes_per_s);
  last_sent_ = now;
  ++counts_.frames;
  counts_.bytes += bytes.size();
  return bytes;
}

}  // namespace swiftlet
