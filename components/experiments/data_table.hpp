// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The numbers of a text file, gzip-compressed or not: one row a line, separated by commas or
/// spaces. Empty lines and those that begin with '#' are skipped. All rows have as many columns as
/// the first, or the error names file and line.
Result<std::vector<std::vector<double>>> read_table(const std::filesystem::path& file);

/// Files below a folder whose name matches a regular expression, sorted by path.
std::vector<std::filesystem::path> find_files(const std::filesystem::path& folder,
                                              const std::string& pattern);

}  // namespace swiftlet
