// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/cloud_client.hpp"

#include <fmt/format.h>

namespace swiftlet {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(100);

}  // namespace

CloudClient::CloudClient(const ComponentContext& context, const CloudParams& params,
                         Terminal& terminal)
    : Component(context),
      params_(params),
      terminal_(terminal),
      collector_(params.voxel),
      begin_(now()) {
  subscribe(topic::odometry,
            [this](const nav_msgs::msg::Odometry& odometry) { collector_.hear(odometry); });
  subscribe(topic::tf_static,
            [this](const tf2_msgs::msg::TFMessage& mounts) { collector_.hear(mounts); });
  if (params_.topic.empty()) {
    subscribe(topic::scan,
              [this](const sensor_msgs::msg::LaserScan& scan) { collector_.hear(scan); });
  } else {
    // Best effort and volatile, so that every writer will do.
    subscribe(Topic<sensor_msgs::msg::PointCloud2>{params_.topic.c_str(), qos::bulk},
              [this](const sensor_msgs::msg::PointCloud2& cloud) { collector_.hear(cloud); });
  }
  every(kTick, [this](Time now) { advance(now); });
}

void CloudClient::advance(Time now) {
  if (!first_ && collector_.cloud().size() > 0) first_ = now;
  if (!first_) {
    terminal_.show(fmt::format("cloud: {} heard, none placed yet", collector_.heard()));
    if (now - begin_ < params_.patience) return;
    problem_ = why_nothing();
    return stop(1);
  }
  terminal_.show(fmt::format("cloud: {} points, {:.0f} of {:.0f} s", collector_.cloud().size(),
                             to_seconds(now - *first_), to_seconds(params_.length)));
  if (now - *first_ < params_.length) return;
  done_ = true;
  stop(0);
}

std::string CloudClient::why_nothing() const {
  const double patience = to_seconds(params_.patience);
  if (collector_.heard() > 0) {
    return fmt::format("{} scans were heard in {:g} s, and none could be placed in the map: {}",
                       collector_.heard(), patience, collector_.problem());
  }
  if (params_.topic.empty()) {
    return fmt::format(
        "no scan is heard in domain {} for {:g} s; does a LIDAR's driver run there, and is "
        "--vehicle right? Clouds of another sensor: --topic NAME",
        context().domain, patience);
  }
  return fmt::format(
      "nothing is heard on '{}' in domain {} for {:g} s; is it a PointCloud2, and is somebody "
      "writing it? See: swiftlet topic info {}",
      params_.topic, context().domain, patience, params_.topic);
}

}  // namespace swiftlet
