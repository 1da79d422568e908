// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/first_difference.hpp"

#include <fmt/format.h>

#include <cstring>

#include "components/runtime/reflection/cdr_decoder.hpp"
#include "components/runtime/reflection/value_text.hpp"

namespace swiftlet {
namespace {

/// The bits of a floating-point number, by which NaN equals itself and 0 differs from -0.
std::uint64_t bits(const Value& value) {
  std::uint64_t bits = 0;
  if (const auto* number = std::get_if<float>(&value.content)) {
    std::memcpy(&bits, number, sizeof(*number));
  } else if (const auto* wide = std::get_if<double>(&value.content)) {
    std::memcpy(&bits, wide, sizeof(*wide));
  }
  return bits;
}

bool same(const Value& a, const Value& b) {
  const bool is_float =
      std::holds_alternative<float>(a.content) || std::holds_alternative<double>(a.content);
  if (is_float) return bits(a) == bits(b);
  if (const auto* truth = std::get_if<bool>(&a.content)) return *truth == std::get<bool>(b.content);
  if (const auto* number = std::get_if<std::int64_t>(&a.content)) {
    return *number == std::get<std::int64_t>(b.content);
  }
  if (const auto* number = std::get_if<std::uint64_t>(&a.content)) {
    return *number == std::get<std::uint64_t>(b.content);
  }
  return std::get<std::string>(a.content) == std::get<std::string>(b.content);
}

Difference at(const std::string& field, const Value& a, const Value& b) {
  Difference difference{field, to_line(a), to_line(b)};
  if (difference.a == difference.b) {  // two kinds of NaN
    difference.a += fmt::format(" ({:#x})", bits(a));
    difference.b += fmt::format(" ({:#x})", bits(b));
  }
  return difference;
}

std::optional<Difference> compare(const Value& a, const Value& b, const std::string& field) {
  const bool is_struct = a.type->kind == TypeDescription::Kind::kStruct;
  if (!is_struct && !a.is_list()) {
    if (same(a, b)) return std::nullopt;
    return at(field, a, b);
  }
  if (a.size() != b.size()) {
    return Difference{field, fmt::format("{} elements", a.size()),
                      fmt::format("{} elements", b.size())};
  }
  const auto* packed_a = std::get_if<Value::Numbers>(&a.content);
  const auto* packed_b = std::get_if<Value::Numbers>(&b.content);
  if (packed_a != nullptr && packed_b != nullptr && packed_a->bytes == packed_b->bytes) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::string below = is_struct
                                  ? (field.empty() ? "" : field + ".") + a.type->members[i].name
                                  : fmt::format("{}[{}]", field, i);
    if (auto difference = compare(a.at(i), b.at(i), below)) return difference;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Difference> first_difference(const Value& a, const Value& b) {
  return compare(a, b, "");
}

Result<std::optional<Difference>> first_difference(const TypeDescription& type, const Cdr& a,
                                                   const Cdr& b) {
  const auto value_a = decode(type, a);
  if (!value_a.ok()) return value_a.error();
  const auto value_b = decode(type, b);
  if (!value_b.ok()) return value_b.error();
  return first_difference(*value_a, *value_b);
}

}  // namespace swiftlet
