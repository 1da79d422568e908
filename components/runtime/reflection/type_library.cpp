// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/type_library.hpp"

#include <algorithm>
#include <iterator>

#include "components/runtime/message.hpp"
#include "components/runtime/reflection/type_resolver.hpp"

namespace swiftlet {

std::size_t size_of(Primitive primitive) {
  switch (primitive) {
    case Primitive::kBoolean:
    case Primitive::kInt8:
    case Primitive::kUint8:
      return 1;
    case Primitive::kInt16:
    case Primitive::kUint16:
      return 2;
    case Primitive::kInt32:
    case Primitive::kUint32:
    case Primitive::kFloat:
      return 4;
    case Primitive::kInt64:
    case Primitive::kUint64:
    case Primitive::kDouble:
      return 8;
  }
  return 1;
}

const TypeDescription* TypeDescription::member(const std::string& member_name) const {
  for (const StructMember& candidate : members) {
    if (candidate.name == member_name) return candidate.type;
  }
  return nullptr;
}

Result<TypeLibrary> TypeLibrary::parse(const std::vector<IdlFile>& files) {
  std::vector<IdlDefinition> definitions;
  for (const IdlFile& file : files) {
    auto parsed = parse_idl(file);
    if (!parsed.ok()) return parsed.error();
    std::move(parsed->begin(), parsed->end(), std::back_inserter(definitions));
  }
  return resolve_types(std::move(definitions));
}

const TypeLibrary& TypeLibrary::built_in() {
  // A test parses the same files, so that they cannot be wrong here.
  static const TypeLibrary library = [] {
    auto parsed = parse(idl_files());
    return parsed.ok() ? std::move(*parsed) : TypeLibrary();
  }();
  return library;
}

const TypeDescription* TypeLibrary::find(const std::string& name) const {
  const auto found = structs_.find(with_slashes(ros_type_name(name)));
  return found == structs_.end() ? nullptr : &found->second;
}

std::vector<const TypeDescription*> TypeLibrary::structs() const {
  std::vector<const TypeDescription*> all;
  for (const auto& [name, type] : structs_) all.push_back(&type);
  return all;
}

}  // namespace swiftlet
