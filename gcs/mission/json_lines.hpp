// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace swiftlet {

/// A value of a JSON text, which knows its line. What is asked for and is not there, or is of
/// another type, throws LineProblem.
class JsonValue {
 public:
  int line() const { return line_; }
  bool is_null() const { return !is_list() && !is_object() && scalar_.is_null(); }
  bool is_list() const { return kind_ == Kind::kList; }
  bool is_object() const { return kind_ == Kind::kObject; }

  /// A member of an object; null where there is none of that name.
  const JsonValue* find(const std::string& key) const;
  const JsonValue& at(const std::string& key) const;
  const std::vector<JsonValue>& list() const;  ///< of a list, its values

  double number() const;  ///< finite
  int whole() const;      ///< a number without a fraction
  bool truth() const;
  const std::string& text() const;
  /// In a word or two, for errors: "'abc'", "a list".
  std::string describe() const;

 private:
  friend class JsonBuilder;
  enum class Kind { kScalar, kList, kObject };

  int line_ = 1;
  Kind kind_ = Kind::kScalar;
  nlohmann::json scalar_;
  std::vector<std::string> keys_;  ///< of an object, beside values_
  std::vector<JsonValue> values_;
};

/// Throws LineProblem where the text is no JSON, has a key twice, or nests deeper than any mission.
JsonValue parse_json(const std::string& text);

}  // namespace swiftlet
