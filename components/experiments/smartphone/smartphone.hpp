// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/experiments/experiment.hpp"

/// The two experiments of seed 000, "Experimental Results", in simulation.
namespace swiftlet {

/// "System Stabilization": hover, with pushes. Tables 2 and 3, figures 7 and 8.
Result<ExperimentResult> run_smartphone_hover(const ExperimentOptions& options);

/// "Autonomous Navigation": the oval at 1, 1.5 and 2.5 m/s. Tables 4 and 5, figures 10 to 12.
Result<ExperimentResult> run_smartphone_trajectory(const ExperimentOptions& options);

}  // namespace swiftlet
