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

OutlookClient::OutlookClient(const ComponentContext& context, Duration patience, bool on_earth)
    : VehicleListener(context), on_earth_(on_earth), deadline_(now() + patience) {
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
  every(kTick, [this](Time now) { advance(now); });
}

bool OutlookClient::knows_all_but_map(Time now) const {
  return model_.vehicle().fresh(now) && model_.pose().known() && model_.limits().known() &&
         model_.battery().known() && (!on_earth_ || model_.origin());
}

void OutlookClient::advance(Time now) {
  const bool is_there =
      model_.vehicle().known() || model_.pose().known() || model_.mission().known();
  if (!heard_ && is_there) heard_ = now;
  if (!nearly_ && knows_all_but_map(now)) nearly_ = now;
  const bool has_waited = heard_ ? now - *heard_ >= kMoment : now >= deadline_;
  const bool is_complete = nearly_ && (model_.map() || now - *nearly_ >= kMapMoment);
  if (!has_waited && !is_complete) return;
  circumstances_ = circumstances_of(model_, now);
  if (on_earth_ && !model_.origin()) circumstances_->unknown.push_back("where the map is on Earth");
  stop(0);
}

}  // namespace swiftlet
