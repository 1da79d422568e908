// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds the one-shot verbs of the ground station to the command `gcs`. They run while the command
/// line is parsed; one that fails throws CLI::RuntimeError with exit code 1.
void add_gcs_commands(CLI::App& gcs);

}  // namespace swiftlet
