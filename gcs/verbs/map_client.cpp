// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/map_client.hpp"

#include "components/conversions.hpp"
#include "gcs/screen/shell/reports.hpp"

namespace swiftlet {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(50);

}  // namespace

MapClient::MapClient(const ComponentContext& context, Duration patience, bool scene)
    : Component(context) {
  subscribe(topic::map, [this](const nav_msgs::msg::OccupancyGrid& map) {
    map_ = map;
    model_.hear_map(screen::map_of(map), now());
    if (!heard_) heard_ = now();
  });
  if (scene) listen_to_vehicle();
  const Time deadline = now() + patience;
  every(kTick, [this, scene, deadline](Time now) {
    const bool complete = heard_ && (!scene || is_complete() || now - *heard_ >= kSceneWait);
    if (complete) return stop(0);
    if (!heard_ && now >= deadline) stop(1);
  });
}

void MapClient::listen_to_vehicle() {
  subscribe(topic::vehicle_status, [this](const swiftlet_msgs::msg::VehicleStatus& status) {
    model_.hear(screen::report_of(status), now());
  });
  subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
    model_.hear(from_msg(odometry), now());
  });
  subscribe(topic::path, [this](const nav_msgs::msg::Path& path) {
    model_.hear_path(screen::places_of(path), now());
  });
}

bool MapClient::is_complete() const {
  if (!model_.pose().known() || !model_.vehicle().known()) return false;
  return !model_.vehicle()->navigates || model_.path().known();
}

}  // namespace swiftlet
