// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/experiments/experiment.hpp"

namespace swiftlet {

/// The unknown house, explored and left: our explorer beside the nearest frontier, flown to its end
/// (Yamauchi, CIRA 1997).
Result<ExperimentResult> run_exploration(const ExperimentOptions& options);

}  // namespace swiftlet
