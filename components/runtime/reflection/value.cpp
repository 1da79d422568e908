// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/value.hpp"

#include <cstring>

namespace swiftlet {
namespace {

template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

}  // namespace

std::size_t Value::size() const {
  if (const auto* parts = std::get_if<Parts>(&content)) return parts->size();
  if (const auto* numbers = std::get_if<Numbers>(&content)) {
    return numbers->bytes.size() / size_of(numbers->primitive);
  }
  return 0;
}

Value Value::at(std::size_t index) const {
  if (const auto* parts = std::get_if<Parts>(&content)) return parts->at(index);
  const auto& numbers = std::get<Numbers>(content);
  return primitive_value(*type->element, &numbers.bytes.at(index * size_of(numbers.primitive)));
}

Value primitive_value(const TypeDescription& type, const std::uint8_t* bytes) {
  Value value;
  value.type = &type;
  switch (type.primitive) {
    case Primitive::kBoolean:
      value.content = load<std::uint8_t>(bytes) != 0;
      break;
    case Primitive::kInt8:
      value.content = std::int64_t{load<std::int8_t>(bytes)};
      break;
    case Primitive::kUint8:
      value.content = std::uint64_t{load<std::uint8_t>(bytes)};
      break;
    case Primitive::kInt16:
      value.content = std::int64_t{load<std::int16_t>(bytes)};
      break;
    case Primitive::kUint16:
      value.content = std::uint64_t{load<std::uint16_t>(bytes)};
      break;
    case Primitive::kInt32:
      value.content = std::int64_t{load<std::int32_t>(bytes)};
      break;
    case Primitive::kUint32:
      value.content = std::uint64_t{load<std::uint32_t>(bytes)};
      break;
    case Primitive::kInt64:
      value.content = load<std::int64_t>(bytes);
      break;
    case Primitive::kUint64:
      value.content = load<std::uint64_t>(bytes);
      break;
    case Primitive::kFloat:
      value.content = load<float>(bytes);
      break;
    case Primitive::kDouble:
      value.content = load<double>(bytes);
      break;
  }
  return value;
}

}  // namespace swiftlet
