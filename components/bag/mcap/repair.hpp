// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/bag/mcap/byte_source.hpp"
#include "components/bag/mcap/records.hpp"

namespace swiftlet::mcap {

/// What a repair saved, and what it could not.
struct Repair {
  Statistics saved;
  std::uint64_t lost_chunks = 0;
  std::uint64_t lost_messages = 0;    ///< that are known by number
  std::uint64_t skipped_bytes = 0;    ///< part of nothing known
  std::vector<std::string> problems;  ///< each with its place
};

/// Writes a sound file with all that can be read of a damaged one, and a metadata record called
/// `record` with what could not. An existing file `out` is replaced. The same bytes give the same
/// file. An error where nothing is of MCAP, or `out` cannot be written; `out` is then gone.
Result<Repair> repair(const ByteSource& source, const std::filesystem::path& out,
                      const std::string& record);

}  // namespace swiftlet::mcap
