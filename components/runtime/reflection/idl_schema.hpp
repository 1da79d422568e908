// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/reflection/idl_files.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The text of an MCAP schema of encoding `ros2idl` for a type such as `sensor_msgs/msg/Imu`: the
/// IDL of the type and of all types that it consists of, each below a line of 80 '=' and a line
/// `IDL: sensor_msgs/msg/Imu`, the type itself first. The IDL files are built into the library.
Result<std::string> idl_schema(const std::string& type_name);

/// The same for other IDL files. The constants of a struct `Name` stand in a module
/// `Name_Constants` beside it, as rosidl writes them.
Result<std::string> idl_schema(const std::string& type_name, const std::vector<IdlFile>& files);

}  // namespace swiftlet
