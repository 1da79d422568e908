// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/experiments/experiment.hpp"

namespace swiftlet {

/// The hardest problems of every public map, by our any-angle planner and by those of OMPL.
Result<ExperimentResult> run_planning_benchmark(const ExperimentOptions& options);

}  // namespace swiftlet
