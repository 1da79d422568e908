// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace swiftlet {

/// What may stand in place of the last of `words`, which is the beginning of it or empty: verbs,
/// options where it begins with a dash, and components where they are named. Sorted; empty where a
/// file or a number is expected. `words` are those behind the program's name.
std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace swiftlet
