// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/lidar_mapper/grid_message.hpp"

#include <cmath>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

constexpr std::int8_t kUnknown = -1;

std::int8_t percent_of(std::int16_t evidence) {
  if (evidence == OccupancyGrid::kNoEvidence) return kUnknown;
  const double log_odds = evidence / OccupancyGrid::kEvidencePerLogOdds;
  return static_cast<std::int8_t>(std::lround(100.0 / (1.0 + std::exp(-log_odds))));
}

}  // namespace

nav_msgs::msg::OccupancyGrid to_msg(const OccupancyGrid& grid, Time time) {
  nav_msgs::msg::OccupancyGrid message;
  message.header(make_header(time, "map"));
  message.info().map_load_time(to_msg(time));
  message.info().resolution(static_cast<float>(grid.resolution()));
  message.info().width(static_cast<std::uint32_t>(grid.width()));
  message.info().height(static_cast<std::uint32_t>(grid.height()));
  message.info().origin(
      to_pose({grid.origin().x(), grid.origin().y(), 0.0}, Eigen::Quaterniond::Identity()));
  std::vector<std::int8_t> data(grid.evidence().size());
  // Most cells are as sure as can be, and so are those beside them.
  std::int16_t last = OccupancyGrid::kNoEvidence;
  std::int8_t percent = kUnknown;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::int16_t evidence = grid.evidence()[i];
    if (evidence != last) percent = percent_of(evidence);
    last = evidence;
    data[i] = percent;
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
  grid.set_percents(message.data());
  return grid;
}

}  // namespace swiftlet
