// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace swiftlet::screen {

/// One parameter of a component, as it was heard.
struct ParameterEntry {
  /// When it may be set.
  enum class Changes { kAtStart, kOnGround, kAtAnyTime };
  std::string name;
  std::string value;   ///< as in YAML
  std::string limits;  ///< "" where there are none
  Changes changes = Changes::kAtStart;
};

/// What the parameter editor shows: components, or the parameters of one of them.
struct ParameterList {
  std::string component;  ///< "" while components are shown
  std::vector<std::string> components;
  std::vector<ParameterEntry> entries;
  int selected = 0;

  int size() const {
    return static_cast<int>(component.empty() ? components.size() : entries.size());
  }
};

}  // namespace swiftlet::screen
