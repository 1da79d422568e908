// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "components/cli/trajectory_file.hpp"

namespace swiftlet {

/// What there is to say about a planned trajectory, in every form.
struct TrajectoryReport {
  TrajectoryFile task;
  Trajectory trajectory;
};

/// A table for a person: duration, cost, each limit beside the extreme, the pieces.
std::string to_text(const TrajectoryReport& report);
std::string to_json(const TrajectoryReport& report);

/// Samples at 100 Hz and at the end: position and its derivatives up to the snap, yaw, thrust per
/// mass, and the body's angular velocity.
Status write_csv(const TrajectoryReport& report, const std::filesystem::path& file);
/// A figure of the way and of everything that is limited.
Status write_plot(const TrajectoryReport& report, const std::filesystem::path& file);

}  // namespace swiftlet
