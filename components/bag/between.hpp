// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

namespace swiftlet {

/// Accepts numbers from `min` to `max`, and no NaN, which CLI::Range lets pass.
inline CLI::Validator between(double min, double max) {
  const auto check = [min, max](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_inside = end != text.c_str() && *end == '\0' && value >= min && value <= max;
    return is_inside ? std::string() : fmt::format("{} is not from {} to {}", text, min, max);
  };
  return {check, fmt::format("[{} - {}]", min, max)};
}

}  // namespace swiftlet
