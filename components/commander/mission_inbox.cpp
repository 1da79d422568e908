// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/mission_inbox.hpp"

#include <fmt/format.h>

#include "components/commander/mission_message.hpp"

namespace swiftlet {

Status MissionInbox::add(const swiftlet_msgs::msg::MissionPart& part) {
  if (part.id().empty()) return Error{"mission refused: the upload has no id"};
  if (part.count() == 0 || part.count() > most_items_) {
    return Error{fmt::format("mission refused: it has {} items, 1 to {} can be flown", part.count(),
                             most_items_)};
  }
  if (part.id() != id_) {
    id_ = part.id();
    checksum_ = part.checksum();
    items_.assign(part.count(), std::nullopt);
    have_ = 0;
  }
  const std::size_t end = static_cast<std::size_t>(part.first()) + part.items().size();
  if (part.count() != items_.size() || part.checksum() != checksum_ || end > items_.size()) {
    return Error{
        fmt::format("mission refused: a part of upload '{}' contradicts another one", id_)};
  }
  for (std::size_t i = part.first(); i < end; ++i) {
    if (!items_[i]) ++have_;
    items_[i] = part.items()[i - part.first()];
  }
  return {};
}

std::vector<std::uint32_t> MissionInbox::missing(std::size_t most) const {
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < items_.size() && indices.size() < most; ++i) {
    if (!items_[i]) indices.push_back(static_cast<std::uint32_t>(i));
  }
  return indices;
}

Result<MissionInbox::Items> MissionInbox::mission() const {
  Items items;
  for (const auto& item : items_) {
    if (!item) return Error{"mission refused: it is not complete"};
    items.push_back(*item);
  }
  if (checksum(items) != checksum_) {
    return Error{
        "mission refused: its checksum is wrong, it was damaged on the way; send it again"};
  }
  return items;
}

}  // namespace swiftlet
