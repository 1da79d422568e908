// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "components/bag/mcap/bytes.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet::mcap {

/// Where an MCAP file is read from. Every read is checked against the size, so that a length in a
/// damaged file can never ask for more memory than the file has bytes.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Stands for the file in error messages.
  virtual const std::string& name() const = 0;
  virtual std::uint64_t size() const = 0;
  /// Overwrites `out` with `length` bytes from `offset` on; an error when there are fewer.
  virtual Status read(std::uint64_t offset, std::uint64_t length, Bytes& out) const = 0;
};

/// A file on disk. It stays readable while somebody appends to it; `size()` is that of opening.
Result<std::shared_ptr<const ByteSource>> open_file(const std::filesystem::path& path);

/// Bytes in memory.
std::shared_ptr<const ByteSource> from_memory(Bytes bytes, std::string name);

/// "flight.mcap: byte 1234: <problem>", the form of all errors about a place in a file.
Error error_at(const ByteSource& source, std::uint64_t offset, const std::string& problem);

}  // namespace swiftlet::mcap
