// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/state/controller.hpp"
#include "gcs/screen/state/ground_station_model.hpp"

/// The parts of the screen but the map.
namespace swiftlet::screen {

/// "0.4 s", "12 s", "3 min".
std::string age_text(Duration age);
/// "12 min", "45 s", "> 99 min"; "?" where it is not known.
std::string time_left_text(std::optional<double> seconds);

/// Of the flight panel, below the horizon.
int flight_rows(const GroundStationModel& model);

void paint_header(const Pane& pane, const GroundStationModel& model, Time now);
void paint_flight(const Pane& pane, const GroundStationModel& model, Time now);
void paint_health(const Pane& pane, const GroundStationModel& model, Time now);
void paint_link(const Pane& pane, const GroundStationModel& model, Time now);
/// The newest at the bottom, or what stands `up` lines above it. How far up there is something.
int paint_events(const Pane& pane, const EventLog& log, int up = 0);
/// `origin`: where the map is on Earth, where that is known.
void paint_waypoints(const Pane& pane, const Controller& controller,
                     const std::optional<LocalOrigin>& origin);
void paint_message(const Pane& pane, const GroundStationModel& model, const Controller& controller,
                   Time now);
void paint_hints(const Pane& pane, const Controller& controller);
void paint_help(const Pane& pane, Keyboard keyboard);
void paint_parameters(const Pane& pane, const ParameterList& list);

Style style_of(Severity severity);

}  // namespace swiftlet::screen
