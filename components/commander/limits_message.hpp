// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config/config.hpp"
#include "control/mission_runner.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// What a commander with these parameters holds flights to. `endurance` is of its section: nobody
/// on board needs it. Throws ConfigError.
swiftlet_msgs::msg::FlightLimits make_limits(const Config& config,
                                             const FlightDirector::Params& director,
                                             const MissionRunner::Params& runner);

}  // namespace swiftlet
