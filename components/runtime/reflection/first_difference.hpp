// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/runtime/message.hpp"
#include "components/runtime/reflection/value.hpp"

namespace swiftlet {

struct Difference {
  std::string field;  ///< "pose.pose.position.x", "ranges[17]"
  std::string a;      ///< what stands there, as text
  std::string b;
};

/// The first field, in the order of the type, in which two messages differ; nothing where they are
/// the same bit by bit. Byte order and padding do not count. Of two lists of different length, the
/// lengths are named. An error where one of them is no such message.
Result<std::optional<Difference>> first_difference(const TypeDescription& type, const Cdr& a,
                                                   const Cdr& b);

/// The same for messages that were decoded; both of one type.
std::optional<Difference> first_difference(const Value& a, const Value& b);

}  // namespace swiftlet
