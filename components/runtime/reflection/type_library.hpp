// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/runtime/reflection/idl_files.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// What is a number or a truth value on the wire.
enum class Primitive {
  kBoolean,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble
};

std::size_t size_of(Primitive primitive);  ///< bytes, which is its alignment, too

struct StructMember;

/// A type that the IDL files describe, as far as it matters on the wire.
struct TypeDescription {
  enum class Kind { kPrimitive, kString, kArray, kSequence, kStruct };
  Kind kind = Kind::kPrimitive;
  /// "sensor_msgs/msg/Imu" of a struct; else as in IDL: "double[9]", "sequence<float>".
  std::string name;
  Primitive primitive = Primitive::kUint8;
  /// Elements of an array; the most that a string or sequence may have, 0 for no limit.
  std::uint32_t count = 0;
  const TypeDescription* element = nullptr;  ///< of an array or sequence
  std::vector<StructMember> members{};       ///< of a struct
  std::size_t minimum_size = 0;              ///< bytes that a value has at least, without padding

  const TypeDescription* member(const std::string& member_name) const;
};

struct StructMember {
  std::string name;
  const TypeDescription* type = nullptr;
};

/// Types by name, made from the text of IDL files alone.
class TypeLibrary {
 public:
  /// Definitions may refer to others in any order and file. An enum counts as the 32 bits that it
  /// has on the wire. Refused: what parse_idl refuses, names that nothing defines, structs that
  /// contain themselves other than in a sequence, values of more than 1 GiB.
  static Result<TypeLibrary> parse(const std::vector<IdlFile>& files);

  /// The types of idl/.
  static const TypeLibrary& built_in();

  /// In any spelling: "sensor_msgs/msg/Imu", "sensor_msgs::msg::Imu", or as on the wire,
  /// "sensor_msgs::msg::dds_::Imu_". Null where no struct has that name.
  const TypeDescription* find(const std::string& name) const;

  /// All structs, by name.
  std::vector<const TypeDescription*> structs() const;

 private:
  friend class TypeResolver;
  std::map<std::string, TypeDescription> structs_;               // by "a/msg/B"
  std::vector<std::unique_ptr<TypeDescription>> other_types_{};  // what structs are made of
};

}  // namespace swiftlet
