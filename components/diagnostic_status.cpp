// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/diagnostic_status.hpp"

#include <fmt/format.h>

namespace swiftlet {

void add_value(diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key,
               const std::string& value) {
  diagnostic_msgs::msg::KeyValue entry;
  entry.key(key);
  entry.value(value);
  status.values().push_back(entry);
}

void add_value(diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key,
               std::uint64_t value) {
  add_value(status, key, std::to_string(value));
}

void add_value(diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key,
               double value) {
  add_value(status, key, fmt::format("{:.4g}", value));
}

}  // namespace swiftlet
