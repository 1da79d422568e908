// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"

namespace swiftlet {

/// Parameters of a component that may be set while it runs, by their dotted names, and how.
struct ChangeableParameters {
  std::vector<std::string> at_any_time;
  std::vector<std::string> on_ground;  ///< and before lift-off
  /// Whether it is too late for those `on_ground`; without it never.
  std::function<bool()> flies;
  /// Uses a configuration in which one of them is new, or throws ConfigError or
  /// std::invalid_argument where it cannot be used, with nothing changed.
  std::function<void(const Config& changed)> apply;
};

}  // namespace swiftlet
