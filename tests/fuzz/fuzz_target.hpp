// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What fuzz targets share. Each is one file with LLVMFuzzerTestOneInput, linked with libFuzzer by
// `make fuzz` and with driver.cpp in the tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace swiftlet::fuzz {

/// What must hold for every input. Ends the program where it does not, as both drivers expect.
inline void demand(bool holds, const char* what, const std::string& detail = {}) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s %s\n", what, detail.c_str());
  std::abort();
}

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Bytes that were asked of operator new in this thread so far.
std::size_t allocated();

/// Writes `bytes` to a file in memory that is there as long as this object, for what reads files
/// only.
class FileInMemory {
 public:
  FileInMemory(const char* extension, const std::uint8_t* bytes, std::size_t size);
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace swiftlet::fuzz
