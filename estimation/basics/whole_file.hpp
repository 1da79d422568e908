// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Writes a file that appears whole, under its name, or not at all.
Status write_whole(const std::filesystem::path& file, const std::string& content);

/// Whether it could be written there now, for who has long to work before there is something to
/// write. An error says what is in the way, and what to do.
Status check_writable(const std::filesystem::path& file);

}  // namespace swiftlet
