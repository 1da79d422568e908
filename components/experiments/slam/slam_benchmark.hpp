// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/experiments/experiment.hpp"

namespace swiftlet {

/// The public SLAM benchmark (Kuemmerle et al. 2009): every log in the folder through a recording
/// and `lidar_mapper`, scored by the relations that people have verified.
Result<ExperimentResult> run_slam_benchmark(const ExperimentOptions& options);

}  // namespace swiftlet
