// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/logger.h>

#include <cstdint>
#include <memory>
#include <string>

namespace swiftlet {

/// A line of log goes to standard error: "[time] [level] component: text".
using Logger = std::shared_ptr<spdlog::logger>;

/// The logger of a component; the same one for the same name.
Logger logger(const std::string& name);

/// One of trace, debug, info, warning, error, off. False where it is none of them.
bool set_log_level(const std::string& level);

/// Whether the `count`th time of something is worth a line: the 1st, the 2nd, the 4th, ... are, so
/// that what happens a thousand times a second does not flood the log.
constexpr bool is_worth_a_line(std::uint64_t count) {
  return (count & (count - 1)) == 0;
}

}  // namespace swiftlet
