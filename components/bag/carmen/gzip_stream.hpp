// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <string>

namespace swiftlet::carmen {

/// Reads a file, decompressing it where it is a gzip file. A damaged or cut file sets bad().
class GzipStream : public std::istream {
 public:
  explicit GzipStream(const std::filesystem::path& path);
  ~GzipStream() override;

  /// Why the file could not be opened; empty where it could.
  const std::string& error() const { return error_; }

 private:
  class Buffer;
  std::unique_ptr<Buffer> buffer_;
  std::string error_;
};

}  // namespace swiftlet::carmen
