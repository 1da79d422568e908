// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "components/report/flight_story.hpp"
#include "components/report/map_picture.hpp"

namespace swiftlet {

/// A line in a plot.
struct PlotLine {
  std::string name;
  std::string look;  ///< class in page.css
  const ThinnedCurve* curve = nullptr;
};

/// Lines over time in one pair of axes.
struct TimePlot {
  std::string section;  ///< of the page: "Position", "Battery", ...
  std::string title, unit;
  int digits = 2;      ///< behind the point, that are worth showing
  double reach = 0.0;  ///< a sample is shown for a moment that is at most so far away [s]
  std::vector<PlotLine> lines;
};

/// The plots that the story has something for.
std::vector<TimePlot> plots_of(const FlightStory& story);

/// What the page's script draws: plots, modes, marks of what went wrong, and the map.
nlohmann::json page_data(const FlightStory& story, const std::vector<TimePlot>& plots,
                         const std::optional<MapPicture>& picture);

/// Whether there is something to draw on a map.
bool has_map(const FlightStory& story);

}  // namespace swiftlet
