// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace swiftlet {

namespace detail {
template <typename Number>
CLI::Validator number_within(const char* kind, Number least, Number most) {
  const auto check = [=](const std::string& text) -> std::string {
    Number number{};
    const bool is_number = CLI::detail::lexical_cast(text, number);
    if (is_number && number >= least && number <= most) return "";
    return fmt::format("'{}' is no {} from {} to {}", text, kind, least, most);
  };
  return {check, fmt::format("[{} - {}]", least, most)};
}
}  // namespace detail

/// For options of the command line: a number from `least` to `most`, and no NaN, which CLI11's own
/// check lets pass.
inline CLI::Validator within(double least, double most) {
  return detail::number_within("number", least, most);
}

inline CLI::Validator whole_within(std::int64_t least, std::int64_t most) {
  return detail::number_within("whole number", least, most);
}

}  // namespace swiftlet
