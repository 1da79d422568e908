// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/bag/recording.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The stack's name of a recorded topic: "odometry" of "uav1/odometry" where the vehicle is "uav1",
/// and of "/odometry" as other recorders have it. Nothing where it is of another vehicle.
std::optional<std::string> topic_of_vehicle(const std::string& recorded,
                                            const std::string& vehicle);

/// Of which vehicle the recording is: `wanted`, or where that is "" the only one. Fails where it
/// has several, or not the one that is wanted; the error names those that are there.
Result<std::string> vehicle_of(const Recording& recording, const std::string& wanted);

}  // namespace swiftlet
