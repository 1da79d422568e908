// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/basics/result.hpp"
#include "perception/slam/scan_map.hpp"
#include "swiftlet_maps.h"

namespace swiftlet {

swiftlet_maps::msg::LidarMap to_msg(const SlamMap& map, Time time);

/// The map of a message. Fails where the message contradicts itself or has numbers that are none:
/// the reason names the keyframe or constraint.
Result<SlamMap> from_msg(const swiftlet_maps::msg::LidarMap& message);

}  // namespace swiftlet
