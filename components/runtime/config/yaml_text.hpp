// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace YAML {
class Node;
}

namespace swiftlet {

/// Why a text cannot be used as YAML, and on which line, from 1.
class YamlProblem : public std::runtime_error {
 public:
  YamlProblem(int line, const std::string& problem) : runtime_error(problem), line_(line) {}
  int line() const { return line_; }

 private:
  int line_;
};

/// From 1; what is not there has no line of its own.
int line_of(const YAML::Node& node);

/// Reads YAML that anybody may have written. Throws YamlProblem where it is none, has a key twice,
/// or is larger, deeper, or by its aliases longer than any configuration: the parser and whoever
/// walks through the nodes would take gigabytes, or for ever.
YAML::Node parse_yaml(const std::string& text);

}  // namespace swiftlet
