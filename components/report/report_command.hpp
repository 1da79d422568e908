// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds the verb `report`: the flight report of a recording. Exit codes as everywhere: 1 where the
/// report cannot be written, 2 where the recording cannot be used.
void add_report(CLI::App& app);

}  // namespace swiftlet
