// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Sixteen hexadecimal digits that stand for all messages of a recording: topics, log times and
/// contents in the order of the log times (FNV-1a, 64 bits). Two runs that did the same have the
/// same, however their files were cut into chunks.
Result<std::string> content_hash(const std::filesystem::path& file);

}  // namespace swiftlet
