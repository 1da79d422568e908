// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/idl_schema.hpp"

#include <map>
#include <set>

#include "components/runtime/reflection/idl_parser.hpp"
#include "components/runtime/reflection/type_resolver.hpp"

namespace swiftlet {
namespace {

/// Definitions by their names with slashes: "sensor_msgs/msg/Imu".
using Definitions = std::map<std::string, IdlDefinition>;

Result<Definitions> read_all(const std::vector<IdlFile>& files) {
  Definitions all;
  for (const IdlFile& file : files) {
    auto parsed = parse_idl(file);
    if (!parsed.ok()) return parsed.error();
    for (IdlDefinition& definition : *parsed) {
      all.emplace(with_slashes(definition.full_name()), std::move(definition));
    }
  }
  return all;
}

/// Types and constants that a type mentions.
void mentioned(const IdlType& type, std::vector<std::string>& names) {
  names.push_back(type.name);
  for (const IdlType& element : type.element) mentioned(element, names);
}

/// Without the blanks that comments left.
std::string tidy(const std::string& text) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const std::size_t last = line.find_last_not_of(" \t\r");
    if (last != std::string::npos) out += line.substr(0, last + 1) + "\n";
    begin = end + 1;
  }
  return out;
}

void append(const std::string& type_name, const Definitions& definitions,
            std::set<std::string>& done, std::string& schema) {
  if (!done.insert(type_name).second) return;
  const IdlDefinition& definition = definitions.at(type_name);
  const std::string scope = with_slashes(definition.scope);
  schema += std::string(80, '=') + "\nIDL: " + type_name + "\n";
  std::string closing;
  for (std::size_t begin = 0; begin < scope.size();) {
    const std::size_t end = std::min(scope.find('/', begin), scope.size());
    schema += "module " + scope.substr(begin, end - begin) + " {\n";
    closing += "};\n";
    begin = end + 1;
  }
  const auto constants = definitions.find(type_name + "_Constants");
  if (constants != definitions.end()) schema += tidy(constants->second.text);
  schema += tidy(definition.text) + closing;

  std::vector<std::string> names;
  for (const IdlMember& member : definition.members) mentioned(member.type, names);
  for (const std::string& name : names) {
    const std::string slashed = with_slashes(name);
    for (const std::string& candidate : {slashed, scope + "/" + slashed}) {
      if (definitions.count(candidate) != 0) append(candidate, definitions, done, schema);
    }
  }
}

Result<std::string> schema_of(const std::string& type_name, const Definitions& definitions) {
  const auto found = definitions.find(type_name);
  const bool is_type = found != definitions.end() &&
                       found->second.kind != IdlDefinition::Kind::kModule &&
                       found->second.kind != IdlDefinition::Kind::kConstant;
  if (!is_type) return Error{"no IDL file defines " + type_name};
  std::string schema;
  std::set<std::string> done;
  append(type_name, definitions, done, schema);
  return schema;
}

}  // namespace

Result<std::string> idl_schema(const std::string& type_name) {
  static const Result<Definitions> built_in = read_all(idl_files());
  return built_in.ok() ? schema_of(type_name, *built_in) : built_in.error();
}

Result<std::string> idl_schema(const std::string& type_name, const std::vector<IdlFile>& files) {
  const auto definitions = read_all(files);
  if (!definitions.ok()) return definitions.error();
  return schema_of(type_name, *definitions);
}

}  // namespace swiftlet
