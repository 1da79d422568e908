// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/config/config.hpp"
#include "control/flight_director.hpp"

namespace swiftlet {

/// From the section of a `commander`. Throws ConfigError.
FlightDirector::Params read_director_params(const Config& config);

}  // namespace swiftlet
