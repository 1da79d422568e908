// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/experiments/experiment.hpp"

namespace swiftlet {

/// The unknown house, explored and left: the way past all frontiers beside the nearest one first.
Result<ExperimentResult> run_exploration(const ExperimentOptions& options);

}  // namespace swiftlet
