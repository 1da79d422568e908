// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet {

/// The content of a file, gzip-compressed or not; "" where it cannot be read.
inline std::string read_gzip(const std::filesystem::path& file) {
  std::string content;
  gzFile in = gzopen(file.c_str(), "rb");
  if (in == nullptr) return content;
  std::vector<char> buffer(1 << 16);
  for (int n; (n = gzread(in, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0;) {
    content.append(buffer.data(), static_cast<std::size_t>(n));
  }
  gzclose(in);
  return content;
}

}  // namespace swiftlet
