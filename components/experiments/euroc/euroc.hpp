// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/experiments/experiment.hpp"

/// What seed 000 could not show in its laboratory, on the flights of other people.
namespace swiftlet {

/// The filter on the IMU of every sequence in the folder, with poses made from its ground truth by
/// the simulated phone of Table 2 at 30 Hz.
Result<ExperimentResult> run_euroc_filter(const ExperimentOptions& options);

/// Every ground truth in the folder flown as a reference, slowed down where the vehicle needs it.
Result<ExperimentResult> run_euroc_flights(const ExperimentOptions& options);

}  // namespace swiftlet
