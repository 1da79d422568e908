// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/reflection/value.hpp"

namespace swiftlet {

/// A place in a message, as people write it: "pose.pose.position.x", "poses[2].pose", "ranges[17]".
class FieldPath {
 public:
  /// Refuses what a message of the type can never have, naming the nearest that it can.
  static Result<FieldPath> parse(const TypeDescription& type, const std::string& text);

  /// What stands there; an error where a sequence is too short.
  Result<Value> select(const Value& message) const;

 private:
  std::vector<std::size_t> steps_;  // number of the member or element
  std::vector<std::string> names_;  // of the path up to and with each step
};

}  // namespace swiftlet
