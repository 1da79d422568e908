// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/mission_desk.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/commander/mission_message.hpp"
#include "components/conversions.hpp"

namespace swiftlet {
namespace {

/// Uploads that have ended, kept so that parts of them that are late are not taken for new ones.
constexpr std::size_t kRememberedUploads = 64;
/// An upload of which nothing came for so long stands in nobody's way any more.
constexpr Duration kUploadTimeout = std::chrono::seconds(5);
/// A claw that was not heard for so long is not there.
constexpr Duration kClawTimeout = std::chrono::seconds(1);

std::uint8_t to_msg(MissionRunner::State state) {
  return static_cast<std::uint8_t>(state);
}

ClawProgress progress_of(const swiftlet_msgs::msg::ClawState& claw) {
  using namespace swiftlet_msgs::msg::ClawState_Constants;
  switch (claw.state()) {
    case OPENING:
    case CLOSING:
      return ClawProgress::kMoving;
    case OPEN:
      return ClawProgress::kOpen;
    case CLOSED:
    case HOLDING:
      return ClawProgress::kClosed;
    case FAULT:
      return ClawProgress::kFault;
    default:
      return ClawProgress::kUnknown;
  }
}

Result<std::vector<MissionItem>> items_of(const MissionInbox::Items& messages) {
  std::vector<MissionItem> items;
  for (const auto& message : messages) {
    const auto item = from_msg(message);
    if (!item.ok()) {
      return Error{
          fmt::format("mission refused: item {}: {}", items.size() + 1, item.error().reason)};
    }
    items.push_back(*item);
  }
  return items;
}

}  // namespace

MissionInbox::Items MissionDesk::messages() const {
  MissionInbox::Items messages;
  for (const MissionItem& item : runner_.items()) messages.push_back(swiftlet::to_msg(item));
  return messages;
}

void MissionDesk::hear(const swiftlet_msgs::msg::MissionPart& part, const FlightDirector& director,
                       Time now) {
  // What is late must not bring back what was cleared, nor disturb what came after it.
  if (std::find(ended_.begin(), ended_.end(), part.id()) != ended_.end()) return;
  part_heard_ = now;
  if (part.id() != upload_) {
    end_upload();
    upload_ = part.id();
    refusal_.clear();
  }
  Status taken = inbox_.add(part);
  if (taken.ok() && !inbox_.is_complete()) return;
  if (taken.ok()) taken = take(director);
  if (!taken.ok()) refusal_ = taken.error().reason;
  end_upload();
}

void MissionDesk::refuse(const swiftlet_msgs::msg::MissionPart& part, const std::string& reason,
                         Time now) {
  if (std::find(ended_.begin(), ended_.end(), part.id()) != ended_.end()) return;
  if (uploads() && now - part_heard_ < kUploadTimeout) return;
  end_upload();
  upload_ = part.id();
  refusal_ = reason;
  end_upload();
}

bool MissionDesk::uploads() const {
  return !upload_.empty() && (ended_.empty() || ended_.back() != upload_);
}

/// No part of the last upload is heard any more.
void MissionDesk::end_upload() {
  if (!uploads()) return;
  ended_.push_back(upload_);
  if (ended_.size() > kRememberedUploads) ended_.pop_front();
}

/// The mission that is complete, in place of the one that there was.
Status MissionDesk::take(const FlightDirector& director) {
  const auto mission = inbox_.mission();
  if (!mission.ok()) return mission.error();
  auto items = items_of(*mission);
  if (!items.ok()) return items.error();
  const Status loaded = runner_.load(std::move(*items), director);
  if (!loaded.ok()) return loaded;
  id_ = inbox_.id();
  checksum_ = checksum(*mission);
  return {};
}

std::vector<swiftlet_msgs::msg::MissionPart> MissionDesk::answer(
    const swiftlet_msgs::msg::MissionFetch& fetch, Time now) const {
  return make_parts(now, id_, messages(), fetch.items());
}

void MissionDesk::hear(const swiftlet_msgs::msg::ClawState& claw, Time now) {
  claw_heard_ = now;
  runner_.set_claw(progress_of(claw));
}

std::optional<Result<Acceptance>> MissionDesk::carry_out(
    const swiftlet_msgs::msg::ModeCommand& command, FlightDirector& director,
    const std::optional<LocalOrigin>& origin, Time now) {
  using namespace swiftlet_msgs::msg::ModeCommand_Constants;
  switch (command.command()) {
    case MISSION_START:
      return runner_.start(command.item(), director, origin, now);
    case MISSION_PAUSE:
      return runner_.pause(director, now);
    case MISSION_CLEAR: {
      const Status cleared = runner_.clear();
      if (!cleared.ok()) return Result<Acceptance>(cleared.error());
      id_.clear();
      return Result<Acceptance>(Acceptance::kChanged);
    }
    case CLAW_OPEN:
    case CLAW_CLOSE:
      if (!claw_heard_ || now - *claw_heard_ > kClawTimeout) {
        return Result<Acceptance>(
            Error{"claw refused: no claw is heard; does the component claw run?"});
      }
      runner_.command_claw(command.command() == CLAW_OPEN);
      return Result<Acceptance>(Acceptance::kChanged);
    default:
      return std::nullopt;
  }
}

swiftlet_msgs::msg::MissionState MissionDesk::state(Time now) const {
  const MissionRunner::Memory& memory = runner_.memory();
  swiftlet_msgs::msg::MissionState state;
  state.header(make_header(now, "map"));
  state.state(to_msg(memory.state));
  state.id(id_);
  state.checksum(runner_.items().empty() ? 0 : checksum_);
  state.count(static_cast<std::uint32_t>(runner_.items().size()));
  const bool flies = memory.state == MissionRunner::State::kFlying ||
                     memory.state == MissionRunner::State::kPaused;
  if (flies) state.item(static_cast<std::uint32_t>(memory.item + 1));
  state.reason(memory.reason);
  state.upload_id(upload_);
  state.upload_refused(!refusal_.empty());
  state.upload_reason(refusal_);
  if (upload_ == inbox_.id() && refusal_.empty()) state.missing(inbox_.missing(kMostNamedMissing));
  return state;
}

swiftlet_msgs::msg::MissionPart MissionDesk::whole(Time now) const {
  swiftlet_msgs::msg::MissionPart part;
  part.header(make_header(now, "map"));
  part.id(id_);
  part.checksum(checksum_);
  part.items(messages());
  part.count(static_cast<std::uint32_t>(part.items().size()));
  return part;
}

void MissionDesk::restore(const swiftlet_msgs::msg::MissionPart& whole) {
  auto items = items_of(whole.items());
  if (!items.ok()) return;  // another program's; without a mission nothing of it is flown
  id_ = upload_ = whole.id();
  checksum_ = whole.checksum();
  refusal_.clear();
  end_upload();
  runner_.restore(runner_.memory(), std::move(*items));
}

void MissionDesk::write(swiftlet_msgs::msg::CommanderState& state) const {
  const MissionRunner::Memory& memory = runner_.memory();
  state.mission_state(to_msg(memory.state));
  state.mission_item(static_cast<std::uint32_t>(memory.item));
  state.mission_run_end(static_cast<std::uint32_t>(memory.run_end));
  state.holding(memory.waiting_since.has_value());
  state.waiting_in_item(swiftlet::to_msg(memory.waiting_since.value_or(Time{})));
  state.mission_reason(memory.reason);
  state.claw_commanded(memory.claw_open.has_value());
  state.claw_open(memory.claw_open.value_or(false));
}

void MissionDesk::restore(const swiftlet_msgs::msg::CommanderState& state) {
  MissionRunner::Memory memory;
  for (const auto known : {MissionRunner::State::kReady, MissionRunner::State::kFlying,
                           MissionRunner::State::kPaused, MissionRunner::State::kDone}) {
    if (to_msg(known) == state.mission_state()) memory.state = known;
  }
  memory.item = state.mission_item();
  memory.run_end = state.mission_run_end();
  if (state.holding()) memory.waiting_since = from_msg(state.waiting_in_item());
  memory.reason = state.mission_reason();
  if (state.claw_commanded()) memory.claw_open = state.claw_open();
  runner_.restore(memory, runner_.items());
}

bool differs(const swiftlet_msgs::msg::MissionState& a, const swiftlet_msgs::msg::MissionState& b) {
  swiftlet_msgs::msg::MissionState later = a;
  later.header(b.header());
  return later != b;
}

}  // namespace swiftlet
