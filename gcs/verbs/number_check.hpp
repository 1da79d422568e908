// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace swiftlet {

/// For options of the command line: a number from `least` to `most`. CLI11's own takes NaN.
inline std::function<std::string(const std::string&)> within(double least, double most) {
  return [least, most](const std::string& text) -> std::string {
    double number = 0.0;
    const bool is_number = CLI::detail::lexical_cast(text, number);
    if (is_number && number >= least && number <= most) return "";
    return fmt::format("'{}' is no number from {} to {}", text, least, most);
  };
}

}  // namespace swiftlet
