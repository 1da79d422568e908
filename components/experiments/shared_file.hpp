// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet {

/// A file that comes with the program, by its place below components/ in the source tree: of the
/// installation beside the running program, else of the tree that it was built from. Throws
/// ConfigError where neither has it.
std::filesystem::path shared_file(const std::string& name);

}  // namespace swiftlet
