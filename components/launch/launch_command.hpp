// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds the verb `launch`. It runs while the command line is parsed and throws CLI::RuntimeError
/// with its exit code where that is not 0.
void add_launch(CLI::App& app);

}  // namespace swiftlet
