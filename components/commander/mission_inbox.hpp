// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// Puts the parts of a mission together that come in any order, some again and some never. A part
/// of another upload begins a new one, and what there was of the last is forgotten.
class MissionInbox {
 public:
  using Items = std::vector<swiftlet_msgs::msg::MissionItem>;

  /// A mission of more items is refused.
  explicit MissionInbox(std::size_t most_items = 1000) : most_items_(most_items) {}

  /// An error where the part contradicts itself or those before it.
  Status add(const swiftlet_msgs::msg::MissionPart& part);

  /// Of the upload that is here, "" before the first.
  const std::string& id() const { return id_; }
  bool is_complete() const { return !id_.empty() && have_ == items_.size(); }
  /// Indices of what has not come yet, the first `most` of them.
  std::vector<std::uint32_t> missing(std::size_t most) const;
  /// All of it, once it is complete; an error where its checksum is another one.
  Result<Items> mission() const;

 private:
  std::size_t most_items_;
  std::string id_;
  std::uint32_t checksum_ = 0;
  std::vector<std::optional<swiftlet_msgs::msg::MissionItem>> items_;
  std::size_t have_ = 0;
};

}  // namespace swiftlet
