// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gcs/command/ground_options.hpp"

/// Verbs of the ground station, by subject. Each adds itself to the command `gcs` and runs while
/// the command line is parsed; one that fails throws CLI::RuntimeError with exit code 1, or 2 where
/// what was typed cannot be used.
namespace swiftlet {

void add_battery_verb(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network);
void add_cloud_verbs(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network);
void add_control_verbs(CLI::App& gcs, const std::shared_ptr<GroundOptions>& ground);
void add_follow_verb(CLI::App& gcs, const std::shared_ptr<GroundOptions>& ground);
void add_log_verb(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network);
void add_map_verbs(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network);
void add_mode_verb(CLI::App& gcs, const std::shared_ptr<GroundOptions>& ground);
void add_waypoint_verbs(CLI::App& gcs, const std::shared_ptr<GroundOptions>& ground);

}  // namespace swiftlet
