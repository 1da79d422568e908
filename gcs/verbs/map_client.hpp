// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "components/topics.hpp"
#include "gcs/screen/state/ground_station_model.hpp"

namespace swiftlet {

/// Waits for the map, and, with `scene`, for a moment longer for what is drawn over it; then ends
/// the run: 0, or 1 where no map was heard for `patience`.
class MapClient : public Component {
 public:
  /// How long the vehicle is waited for, once the map is there.
  static constexpr Duration kSceneWait = std::chrono::seconds(1);

  MapClient(const ComponentContext& context, Duration patience, bool scene);

  const std::optional<nav_msgs::msg::OccupancyGrid>& map() const { return map_; }
  /// With the map, and what was heard of the vehicle.
  const screen::GroundStationModel& model() const { return model_; }

 private:
  void listen_to_vehicle();
  bool is_complete() const;

  std::optional<nav_msgs::msg::OccupancyGrid> map_;
  std::optional<Time> heard_;  // the map, first
  screen::GroundStationModel model_;
};

}  // namespace swiftlet
