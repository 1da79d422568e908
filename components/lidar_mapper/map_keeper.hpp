// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "components/lidar_mapper/grid_message.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// Keeps the last map that was published.
class MapKeeper : public Component {
 public:
  explicit MapKeeper(const ComponentContext& context) : Component(context) {
    subscribe(topic::map, [this](const nav_msgs::msg::OccupancyGrid& map) { map_ = map; });
  }

  /// Nothing before the first map.
  std::optional<OccupancyGrid> latest() const {
    if (!map_) return std::nullopt;
    return from_msg(*map_, OccupancyGrid::Params());
  }

 private:
  std::optional<nav_msgs::msg::OccupancyGrid> map_;
};

}  // namespace swiftlet
