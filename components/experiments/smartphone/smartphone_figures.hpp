// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "components/experiments/flight/reference_flight.hpp"

/// Figures 7, 8 and 10 to 12 of seed 000, of one of our flights, in the paper's colours.
namespace swiftlet {

/// Somebody pushes, from when to when [s].
using PushTimes = std::vector<std::pair<double, double>>;

/// figure-07.png (positions) and figure-08.png (velocities) of a hover.
Status draw_hover(const FlightSeries& series, const PushTimes& pushes,
                  const std::filesystem::path& folder);

/// figure-10.png (from above), figure-11.png (positions) and figure-12.png (velocities) of the
/// flight from `begin_s` to `end_s`.
Status draw_trajectory(const FlightSeries& series, double begin_s, double end_s,
                       const std::filesystem::path& folder);

}  // namespace swiftlet
