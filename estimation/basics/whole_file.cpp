// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/basics/whole_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace swiftlet {

Status write_whole(const std::filesystem::path& file, const std::string& content) {
  const std::filesystem::path temporary = file.string() + ".part";
  std::error_code error;
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, error);
      return Error{
          fmt::format("{}: cannot be written; does the folder exist, is it writable, is "
                      "there space left?",
                      file.string())};
    }
  }
  std::filesystem::rename(temporary, file, error);
  if (error) {
    const std::string why = error.message();
    std::filesystem::remove(temporary, error);
    return Error{fmt::format("{}: cannot be written: {}", file.string(), why)};
  }
  return {};
}

}  // namespace swiftlet
