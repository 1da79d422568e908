// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gcs/screen/drawing/map_picture.hpp"
#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/state/controller.hpp"
#include "gcs/screen/state/ground_station_model.hpp"

namespace swiftlet::screen {

/// Smaller screens only say so.
inline constexpr int kLeastWidth = 60;
inline constexpr int kLeastHeight = 20;
inline bool is_large_enough(int width, int height) {
  return width >= kLeastWidth && height >= kLeastHeight;
}

/// Where things are on a screen of a size. An empty area is not shown.
struct Layout {
  Area header, flight, health, map, waypoints, events, link, message, hints;
};
/// `edits_waypoints`: small screens have the waypoints in the place of the health. `values`: rows
/// below the horizon.
Layout layout_of(int width, int height, bool edits_waypoints, int values);

/// Draws the whole screen. The controller's camera learns how large the map is; `picture` is kept
/// by the caller from one time to the next.
void paint(Surface& surface, const GroundStationModel& model, Controller& controller,
           MapPicture& picture, Time now);

}  // namespace swiftlet::screen
