// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/units.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>

namespace swiftlet {
namespace {

/// A number with one of some units behind it; NaN where it is none.
double parse(const std::string& text, const std::map<std::string, double>& units) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return NAN;
  std::string unit;
  for (; *end != '\0'; ++end) {
    if (*end != ' ') unit += static_cast<char>(std::tolower(static_cast<unsigned char>(*end)));
  }
  const auto known = units.find(unit);
  return known == units.end() ? NAN : number * known->second;
}

}  // namespace

std::uint64_t parse_size(const std::string& option, const std::string& text) {
  static const std::map<std::string, double> kUnits = {
      {"", 1.0},   {"b", 1.0},      {"kb", 1e3},        {"mb", 1e6},
      {"gb", 1e9}, {"kib", 1024.0}, {"mib", 1048576.0}, {"gib", 1073741824.0}};
  const double bytes = parse(text, kUnits);
  constexpr double kLargest = 1e15;
  if (bytes >= 1.0 && bytes <= kLargest) return static_cast<std::uint64_t>(bytes);
  throw CLI::ValidationError(
      option, fmt::format("'{}' is no size; write it as 200MB, 1.5GB or 64KiB", text));
}

Duration parse_duration(const std::string& option, const std::string& text) {
  static const std::map<std::string, double> kUnits = {{"", 1.0},     {"ms", 1e-3}, {"s", 1.0},
                                                       {"min", 60.0}, {"m", 60.0},  {"h", 3600.0}};
  const double seconds = parse(text, kUnits);
  constexpr double kShortest = 1e-3, kLongest = 1e8;
  if (seconds >= kShortest && seconds <= kLongest) return from_seconds(seconds);
  throw CLI::ValidationError(
      option, fmt::format("'{}' is no time; write it as 30s, 500ms, 10min or 2h", text));
}

}  // namespace swiftlet
