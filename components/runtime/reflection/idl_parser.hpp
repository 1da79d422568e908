// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/reflection/idl_files.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// A type as it is written; what its names mean is not looked up yet.
struct IdlType {
  std::string name;              ///< "double", "unsigned long", "string", "sequence", "a::msg::B"
  std::vector<IdlType> element;  ///< one, for a sequence
  std::string bound;             ///< of a string or sequence, as it is written; "" without
};

struct IdlMember {
  IdlType type;
  std::string name;
  std::vector<std::string> dimensions;  ///< as they are written
};

struct IdlDefinition {
  enum class Kind { kModule, kStruct, kEnum, kTypedef, kConstant };
  Kind kind = Kind::kStruct;
  std::string scope;                 ///< "sensor_msgs::msg"
  std::string name;                  ///< "Imu"
  std::string text;                  ///< without comments, from its keyword to its semicolon
  std::string where;                 ///< "sensor_msgs.idl:12"
  std::vector<IdlMember> members{};  ///< of a struct; of a typedef the one that it names
  std::string value{};               ///< of a constant, as it is written

  std::string full_name() const { return scope.empty() ? name : scope + "::" + name; }
};

/// All definitions of a file, each module before what is in it. Of IDL 4.2 it knows modules,
/// structs, enums, typedefs, constants, arrays, sequences and strings; annotations are skipped.
/// Unions, maps, inheritance, wide characters and expressions are errors that name the line.
Result<std::vector<IdlDefinition>> parse_idl(const IdlFile& file);

}  // namespace swiftlet
