// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/director_params.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace swiftlet {
namespace {

using Demand = Situation::Demand;

constexpr std::pair<const char*, Demand> kDemands[] = {{"none", Demand::kNone},
                                                       {"hover", Demand::kHover},
                                                       {"return", Demand::kReturn},
                                                       {"land", Demand::kLand}};

/// What a policy asks for: none, hover, return or land.
void read_demand(const Config& config, const char* key, Demand& demand) {
  std::string word;
  for (const auto& [name, value] : kDemands) {
    if (value == demand) word = name;
  }
  config.read(key, word);
  for (const auto& [name, value] : kDemands) {
    if (word != name) continue;
    demand = value;
    return;
  }
  config.fail(key, fmt::format("'{}' is '{}'; it can be none, hover, return or land", key, word));
}

}  // namespace

FlightDirector::Params read_director_params(const Config& config) {
  FlightDirector::Params params;
  config.read("min_altitude", params.modes.min_altitude, kPositive);
  config.read("max_altitude", params.modes.max_altitude, kPositive);
  config.read("takeoff_speed", params.takeoff.velocity, kPositive);
  config.read("landing_speed", params.landing.velocity, kPositive);
  config.read("braking_acceleration", params.braking.acceleration, kPositive);
  config.read("arrival_distance", params.arrival_distance, kPositive);
  config.read("plan_timeout", params.plan_timeout, kPositive);
  config.read("exploration_timeout", params.exploration_timeout, kPositive);
  config.read("estimate_sigma_max", params.estimate_sigma_max, kPositive);
  config.read("heading_sigma_to_arm", params.heading_sigma_to_arm, kPositive);
  config.read("settling_to_arm", params.settling_to_arm, {0.0, 3600.0});
  config.read("min_battery_percentage", params.min_battery_percentage, {0.0, 1.0});

  SteeringLimits& steering = params.steering;
  config.read("stick_speed", steering.speed, {0.05, 20.0});
  config.read("stick_climb_speed", steering.climb_speed, {0.05, 10.0});
  config.read("stick_turn_rate", steering.turn_rate, {0.05, 10.0});
  config.read("stick_dead_band", steering.dead_band, {0.0, 0.5});
  config.read("takeover", params.takeover, {0.01, 1.0});
  if (params.takeover <= steering.dead_band) {
    config.fail("takeover", "'takeover' must be above 'stick_dead_band'");
  }
  config.read("vehicle_radius", params.vehicle_radius, kPositive);
  config.read("obstacle_distance", params.obstacle_distance, {0.05, 10.0});

  config.read("gps_altitude", params.gps_altitude, {0.5, 500.0});
  config.read("gps_speed", params.cruise.velocity, {0.1, 20.0});

  config.read("fence_radius", params.fence.radius, kNotNegative);
  config.read("fence_height", params.fence.height, kNotNegative);
  config.read("low_battery", params.low_battery, {0.0, 1.0});
  config.read("critical_battery", params.critical_battery, {0.0, 1.0});
  if (params.critical_battery > params.low_battery) {
    config.fail("critical_battery", "'critical_battery' must not be above 'low_battery'");
  }
  config.read("link_timeout", params.link_timeout, {0.5, 3600.0});
  read_demand(config, "on_fence", params.on_fence);
  read_demand(config, "on_low_battery", params.on_low_battery);
  read_demand(config, "on_critical_battery", params.on_critical_battery);
  read_demand(config, "on_link_loss", params.on_link_loss);
  return params;
}

}  // namespace swiftlet
