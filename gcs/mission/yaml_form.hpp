// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gcs/mission/mission_file.hpp"

namespace swiftlet {

/// Our own form; README.md shows it. Throws ConfigError and LineProblem.
MissionFile parse_yaml_mission(const std::string& text, const std::string& name);
/// Read again, it is the same mission; a heading that no number of degrees gives exactly is so
/// within a rounding.
std::string format_yaml_mission(const MissionFile& mission);

}  // namespace swiftlet
