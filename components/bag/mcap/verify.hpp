// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/bag/mcap/byte_source.hpp"
#include "components/bag/mcap/reader.hpp"

namespace swiftlet::mcap {

/// What a look at every byte of a file found.
struct Verification {
  Statistics counted;                 ///< of what can be read
  std::uint64_t unknown_records = 0;  ///< of opcodes that this version of the format lacks
  std::vector<std::string> problems;  ///< each with its place; empty: the file is sound
  std::vector<std::string> remarks;   ///< untidy, but nothing is lost by it
};

/// Reads the whole file and checks all that it says about itself: lengths, all checksums,
/// definitions before use, indexes, offsets and counts against what is really there. Goes on
/// behind a damaged chunk. An error where the file cannot be read or is no MCAP file.
Result<Verification> verify(const std::shared_ptr<const ByteSource>& source,
                            const ReaderParams& params = {});

}  // namespace swiftlet::mcap
