// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gcs/command/ground_options.hpp"

namespace swiftlet {

/// Adds the verbs for the vehicle's mission to the command `mission`: upload, download, status,
/// start, pause, clear.
void add_mission_verbs(CLI::App& mission, const std::shared_ptr<GroundOptions>& network);

}  // namespace swiftlet
