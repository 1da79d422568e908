// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Whether `name` is a topic or vehicle name by the rules of ROS 2: letters, digits, underscores
/// and single slashes between, no part beginning with a digit.
Status check_name(const std::string& name);

/// Topic `imu0` of vehicle `uav1` as DDS sees it: `rt/uav1/imu0`. Without a vehicle: `rt/imu0`.
std::string wire_topic(const std::string& vehicle, const std::string& topic);

/// The topic without its prefix `rt/`, and without the vehicle where it is that vehicle's.
std::string topic_of(const std::string& vehicle, const std::string& wire_topic);

}  // namespace swiftlet
