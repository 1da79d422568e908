// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "builtin_interfaces.h"
#include "estimation/basics/time.hpp"
#include "std_msgs.h"

namespace swiftlet {

// A moment of the run as messages carry it.
builtin_interfaces::msg::Time to_msg(Time time);
Time from_msg(const builtin_interfaces::msg::Time& stamp);
std_msgs::msg::Header make_header(Time time, const std::string& frame);

}  // namespace swiftlet
