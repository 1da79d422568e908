// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "diagnostic_msgs.h"

/// Entries of a status on `diagnostics`, which viewers show as text.
namespace swiftlet {

void add_value(diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key,
               const std::string& value);
void add_value(diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key,
               std::uint64_t value);
/// With four digits.
void add_value(diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key,
               double value);

}  // namespace swiftlet
