// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds the verbs for mission files to the command `mission`: validate, convert. They need no
/// vehicle, and run while the command line is parsed; one that fails throws CLI::RuntimeError with
/// exit code 1, or 2 where a file cannot be used.
void add_mission_file_verbs(CLI::App& mission);

}  // namespace swiftlet
