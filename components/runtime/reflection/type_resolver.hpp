// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/reflection/idl_parser.hpp"
#include "components/runtime/reflection/type_library.hpp"

namespace swiftlet {

/// Gives the names in definitions their meaning; see TypeLibrary::parse.
Result<TypeLibrary> resolve_types(std::vector<IdlDefinition> definitions);

/// "sensor_msgs/msg/Imu" of "sensor_msgs::msg::Imu".
std::string with_slashes(const std::string& name);

}  // namespace swiftlet
