// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "components/sim/pilot.hpp"
#include "components/sim/referee.hpp"
#include "components/sim/scenario.hpp"
#include "perception/occupancy_grid.hpp"

namespace swiftlet {

/// Everything that is to be said about a simulated flight.
struct FlightReport {
  Scenario scenario;
  FlightOutcome outcome;
  FlightRecord record;
  std::optional<OccupancyGrid> map;
  double speed_factor = 0.0;            ///< simulated time per time
  std::optional<std::string> bag_hash;  ///< of the recording, where there is one
};

/// The mission was flown to its end and nothing was touched.
bool success(const FlightReport& report);

/// A few lines for people.
std::string summary(const FlightReport& report);

/// Writes report.json, flight.png and, where there is a map, map.pgm, map.yaml and map.png.
Status write(const FlightReport& report, const std::filesystem::path& folder);

}  // namespace swiftlet
