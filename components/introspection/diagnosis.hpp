// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "components/introspection/instances.hpp"

namespace swiftlet {

/// One thing that is wrong, or worth knowing.
struct Finding {
  std::string kind;  ///< for scripts: "qos", "type", "unwritten", "problem", "two active", ...
  bool is_problem = true;
  std::string text;    ///< what is wrong, and where
  std::string remedy;  ///< what to do about it
};

/// What a diagnosis rests on.
struct Evidence {
  GraphView graph;
  std::vector<Instance> instances;
  std::string vehicle;
  int domain = 0;
  Time now{};
};

/// Problems first, then notes. Empty where all is well.
///
/// Problems: ends that do not fit together, topics that a component reads and nobody writes (but
/// for commands, which are written when somebody gives one), what components say that they lack,
/// two active instances of one component, components that fell silent, nothing there at all.
/// Notes: participants that are not ours, with their ends.
std::vector<Finding> diagnose(const Evidence& evidence);

std::string findings_text(const std::vector<Finding>& findings, const Evidence& evidence);
nlohmann::ordered_json findings_json(const std::vector<Finding>& findings);

}  // namespace swiftlet
