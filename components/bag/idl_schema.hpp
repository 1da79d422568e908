// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The text of an MCAP schema of encoding `ros2idl` for a type such as `sensor_msgs/msg/Imu`: the
/// IDL of the type and of all types that it consists of, each below a line of 80 '=' and a line
/// `IDL: sensor_msgs/msg/Imu`, the type itself first. The IDL files are built into the library.
Result<std::string> idl_schema(const std::string& type_name);

/// The same for other IDL files, given by their contents. They may hold, inside
/// `module package { module msg { ... } }`, structs, enums, typedefs and, for the constants of a
/// struct `Name`, a module `Name_Constants`.
Result<std::string> idl_schema(const std::string& type_name, const std::vector<std::string>& files);

/// The names of all structs in idl/.
const std::vector<std::string>& idl_type_names();

}  // namespace swiftlet
