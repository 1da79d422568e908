// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>

namespace swiftlet {

/// A line of log goes to standard error: "[time] [level] component: text".
using Logger = std::shared_ptr<spdlog::logger>;

/// The logger of a component; the same one for the same name.
Logger logger(const std::string& name);

/// One of trace, debug, info, warning, error, off. False where it is none of them.
bool set_log_level(const std::string& level);

}  // namespace swiftlet
