// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "components/runtime/reflection/value.hpp"

namespace swiftlet {

struct TextOptions {
  /// Elements of a list and characters of a text to show; "..." stands for the rest. 0: all.
  std::size_t longest = 128;
  bool lists = true;  ///< else only their type and length
};

/// YAML, as `ros2 topic echo` prints it, a line break at the end. It reads back as the same value
/// where nothing is left out: numbers in the shortest form that does.
std::string to_yaml(const Value& value, const TextOptions& options = {});

/// A single value on one line; of lists and structs only what they are: "sequence<float> of 360".
std::string to_line(const Value& value);

/// Members in their order. JSON has no NaN and no infinity: they are the texts "nan", "inf" and
/// "-inf". With `lists` false, lists are their type and length.
nlohmann::ordered_json to_json(const Value& value, bool lists = true);

}  // namespace swiftlet
