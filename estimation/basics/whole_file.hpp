// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Writes a file that appears whole, under its name, or not at all.
Status write_whole(const std::filesystem::path& file, const std::string& content);

}  // namespace swiftlet
