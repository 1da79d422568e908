// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gcs/screen/drawing/map_drawing.hpp"
#include "gcs/screen/state/ground_station_model.hpp"

namespace swiftlet::screen {

/// What of the vehicle is drawn over the map: where it is and was, where it took off while it
/// flies, and the path while it follows one.
MapScene scene_of(const GroundStationModel& model, Time now);

/// The map as text, north up, all that is known of it, `width` columns wide and as high as that
/// needs, but no higher than half as many rows. Lines end without spaces. Empty where nothing of a
/// map is known.
std::string map_text(const GroundStationModel& model, Time now, int width, bool ascii);

}  // namespace swiftlet::screen
