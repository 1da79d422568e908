// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// `experiment list` and `experiment NAME`.
void add_experiment(CLI::App& app);

}  // namespace swiftlet
