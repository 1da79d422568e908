// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "components/runtime/reflection/type_library.hpp"

namespace swiftlet {

/// A value of a type that is known by its description only. It refers to the description, which
/// must live longer (those of TypeLibrary::built_in() do).
struct Value {
  /// The elements of an array or sequence of primitives, packed: images have millions.
  struct Numbers {
    Primitive primitive = Primitive::kUint8;
    std::vector<std::uint8_t> bytes{};  ///< in the order of this machine
  };
  /// The members of a struct in their order, or the elements of any other array or sequence.
  using Parts = std::vector<Value>;

  const TypeDescription* type = nullptr;
  std::variant<bool, std::int64_t, std::uint64_t, float, double, std::string, Numbers, Parts>
      content{};

  bool is_list() const {
    return type->kind == TypeDescription::Kind::kArray ||
           type->kind == TypeDescription::Kind::kSequence;
  }
  /// Elements of a list, members of a struct.
  std::size_t size() const;
  /// That element or member; packed ones are unpacked.
  Value at(std::size_t index) const;
};

/// The primitive that begins at `bytes`, in the order of this machine.
Value primitive_value(const TypeDescription& type, const std::uint8_t* bytes);

}  // namespace swiftlet
