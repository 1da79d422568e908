// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

namespace swiftlet {

/// Exit codes of verbs.
inline constexpr int kExitFailed = 1;    ///< refused, not answered, or come to another end
inline constexpr int kExitUnusable = 2;  ///< what was typed, or a file, cannot be used

/// Ends a verb with the reason on the error stream.
[[noreturn]] inline void end_verb(int code, const std::string& reason) {
  fmt::print(stderr, "error: {}\n", reason);
  throw CLI::RuntimeError(code);
}

/// What is asked of a person whose vehicle says nothing.
inline std::string nobody_answers(int domain) {
  return fmt::format(
      "no vehicle answers in domain {}; is a commander running there, and is --vehicle right?",
      domain);
}

}  // namespace swiftlet
