// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/outlook_client.hpp"

#include "components/conversions.hpp"
#include "components/fix_message.hpp"
#include "gcs/screen/shell/reports.hpp"

namespace swiftlet {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);

}  // namespace

OutlookClient::OutlookClient(const ComponentContext& context, Duration patience)
    : VehicleListener(context) {
  subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
    model_.hear(from_msg(odometry), now());
  });
  subscribe(
      topic::gps_fix,
      [this](const sensor_msgs::msg::NavSatFix& fix) { model_.hear(from_msg(fix), now()); },
      Need::kOptional);
  subscribe(
      topic::map,
      [this](const nav_msgs::msg::OccupancyGrid& map) {
        model_.hear_map(screen::map_of(map), now());
      },
      Need::kOptional);
  const Time deadline = now() + patience;
  every(kTick, [this, deadline](Time now) {
    if (is_complete() || now >= deadline) stop(0);
  });
}

screen::Circumstances OutlookClient::circumstances() const {
  return circumstances_of(model_, now());
}

bool OutlookClient::is_complete() const {
  return model_.vehicle().known() && model_.pose().known() && model_.limits().known() &&
         model_.battery().known() && model_.map();
}

std::vector<std::string> OutlookClient::unknown() const {
  std::vector<std::string> unknown;
  if (!model_.vehicle().known() || !model_.pose().known()) unknown.push_back("where it takes off");
  if (!model_.limits().known()) unknown.push_back("the fence and speeds");
  if (!model_.battery().known() || !model_.limits().known()) {
    unknown.push_back("the battery's reach");
  } else if (!(model_.limits()->endurance > 0.0)) {
    unknown.push_back("the battery's reach (commander.endurance is not set)");
  }
  if (!model_.map()) unknown.push_back("obstacles");
  return unknown;
}

}  // namespace swiftlet
