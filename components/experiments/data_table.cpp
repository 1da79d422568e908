// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/data_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <string>

#include "components/bag/carmen/gzip_stream.hpp"

namespace swiftlet {

Result<std::vector<std::vector<double>>> read_table(const std::filesystem::path& file) {
  carmen::GzipStream stream(file);
  if (!stream.error().empty()) return Error{fmt::format("{}: {}", file.string(), stream.error())};
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::replace(line.begin(), line.end(), ',', ' ');
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    std::vector<double> row;
    const char* at = line.c_str() + first;
    while (*at != '\0') {
      char* end = nullptr;
      row.push_back(std::strtod(at, &end));
      if (end == at) {
        return Error{fmt::format("{}:{}: '{}' is no number", file.string(), number, at)};
      }
      at = end + std::strspn(end, " \t\r");
    }
    if (!rows.empty() && row.size() != rows.front().size()) {
      return Error{fmt::format("{}:{}: {} columns, {} in the first row", file.string(), number,
                               row.size(), rows.front().size())};
    }
    rows.push_back(std::move(row));
  }
  if (stream.bad()) return Error{fmt::format("{}: is damaged or cut off", file.string())};
  if (rows.empty()) return Error{fmt::format("{}: has no numbers", file.string())};
  return rows;
}

std::vector<std::filesystem::path> find_files(const std::filesystem::path& folder,
                                              const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file(ignored) &&
        std::regex_match(entry.path().filename().string(), expression)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace swiftlet
