// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/grid_message.hpp"

#include <cmath>

#include "components/conversions.hpp"

namespace swiftlet {

nav_msgs::msg::OccupancyGrid to_msg(const OccupancyGrid& grid, Time time) {
  nav_msgs::msg::OccupancyGrid message;
  message.header(make_header(time, "map"));
  message.info().map_load_time(to_msg(time));
  message.info().resolution(static_cast<float>(grid.resolution()));
  message.info().width(static_cast<std::uint32_t>(grid.width()));
  message.info().height(static_cast<std::uint32_t>(grid.height()));
  message.info().origin(
      to_pose({grid.origin().x(), grid.origin().y(), 0.0}, Eigen::Quaterniond::Identity()));
  std::vector<std::int8_t> data;
  data.reserve(grid.evidence().size());
  for (const std::int16_t evidence : grid.evidence()) {
    if (evidence == OccupancyGrid::kNoEvidence) {
      data.push_back(-1);
    } else {
      const double log_odds = evidence / OccupancyGrid::kEvidencePerLogOdds;
      data.push_back(static_cast<std::int8_t>(std::lround(100.0 / (1.0 + std::exp(-log_odds)))));
    }
  }
  message.data(std::move(data));
  return message;
}

OccupancyGrid from_msg(const nav_msgs::msg::OccupancyGrid& message, OccupancyGrid::Params params) {
  // The message's float, as the decimal number that was meant: 0.05f is not 0.05.
  params.resolution = std::round(static_cast<double>(message.info().resolution()) * 1e6) / 1e6;
  const std::size_t cells =
      static_cast<std::size_t>(message.info().width()) * message.info().height();
  const Eigen::Quaterniond turn = from_msg(message.info().origin().orientation());
  const bool turned = !(turn.vec().cwiseAbs().maxCoeff() <= 1e-6);  // not finite is turned, too
  if (turned || !(params.resolution > 0.0) || message.data().size() != cells) {
    return OccupancyGrid(params);
  }
  const Eigen::Vector3d origin = from_msg(message.info().origin().position());
  OccupancyGrid grid(params, origin.head<2>(), static_cast<int>(message.info().width()),
                     static_cast<int>(message.info().height()));
  std::size_t index = 0;
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const std::int8_t percent = message.data()[index++];
      if (percent >= 0) grid.set_probability({x, y}, percent / 100.0);
    }
  }
  return grid;
}

}  // namespace swiftlet
