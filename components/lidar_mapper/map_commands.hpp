// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds the verb `map` with `info`, `draw`, `rooms` and `merge`: what one does with map files. Exit
/// codes as everywhere: 1 where two maps do not belong together, 2 where a file cannot be used.
void add_map(CLI::App& app);

}  // namespace swiftlet
