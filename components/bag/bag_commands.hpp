// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds `info`, `verify` and `convert` to the command `bag`. They run while the command line is
/// parsed. A command that does not end with exit code 0 throws CLI::RuntimeError with the code,
/// which `CLI::App::exit` returns: 1 failed (damage found, disk full), 2 the input cannot be used.
/// Errors go to the error stream and name file, place and remedy.
void add_bag_commands(CLI::App& bag);

}  // namespace swiftlet
