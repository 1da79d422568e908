// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gcs/command/ground_options.hpp"

namespace swiftlet {

/// `swiftlet gcs` without a verb: the screen, until somebody quits. Throws CLI::RuntimeError with
/// exit code 2 where there is no terminal.
void add_screen(CLI::App& gcs, const std::shared_ptr<GroundOptions>& network);

}  // namespace swiftlet
