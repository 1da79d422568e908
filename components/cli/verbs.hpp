// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

/// The verbs of the program. Each adds itself to the command line and runs while it is parsed; one
/// that does not end with exit code 0 throws CLI::RuntimeError with the code: 1 failed, 2 wrong
/// usage or input that cannot be used.
namespace swiftlet {

void add_fly(CLI::App& app);
void add_run(CLI::App& app);
void add_trajectory(CLI::App& app);

}  // namespace swiftlet
