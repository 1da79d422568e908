// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/basics/whole_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

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

Status check_writable(const std::filesystem::path& file) {
  const std::filesystem::path parent = file.parent_path();
  const std::filesystem::path folder = parent.empty() ? "." : parent;
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored) || file.filename().empty()) {
    return Error{fmt::format("{}: is a folder; name a file in it", file.string())};
  }
  if (!std::filesystem::is_directory(folder, ignored)) {
    return Error{fmt::format("{}: cannot be written: there is no folder {}; make it first",
                             file.string(), folder.string())};
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    return Error{
        fmt::format("{}: cannot be written: you may not write into {}; name another folder",
                    file.string(), folder.string())};
  }
  return {};
}

}  // namespace swiftlet
