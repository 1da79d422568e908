// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/limits_message.hpp"

namespace swiftlet {

swiftlet_msgs::msg::FlightLimits make_limits(const Config& config,
                                             const FlightDirector::Params& director,
                                             const MissionRunner::Params& runner) {
  double endurance = 0.0;
  config.read("endurance", endurance, {0.0, 86400.0});
  double margin = 0.1;
  config.read("plan_margin", margin, kNotNegative);
  swiftlet_msgs::msg::FlightLimits limits;
  limits.fence_radius(director.fence.radius);
  limits.fence_height(director.fence.height);
  limits.gps_altitude(director.gps_altitude);
  limits.gps_speed(director.cruise.velocity);
  limits.climb_speed(director.takeoff.velocity);
  limits.descent_speed(director.landing.velocity);
  limits.clearance(director.vehicle_radius + margin);
  limits.low_battery(director.low_battery);
  limits.endurance(endurance);
  limits.most_items(static_cast<std::uint32_t>(runner.most_items));
  return limits;
}

}  // namespace swiftlet
