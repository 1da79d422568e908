// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace swiftlet::screen {

/// One parameter of a component, as it was heard.
struct ParameterEntry {
  std::string name;
  std::string value;   ///< as in YAML
  std::string limits;  ///< "" where there are none
  bool live = false;   ///< may change while the component runs
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
