// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/idl_schema.hpp"

#include <cctype>
#include <map>
#include <set>

#include "components/bag/idl_files.hpp"

namespace swiftlet {
namespace {

/// Everything that one IDL section of a schema holds.
struct Definition {
  std::string package;    // "sensor_msgs"
  std::string name;       // "Imu"
  std::string constants;  // module Imu_Constants { ... };
  std::string body;       // struct Imu { ... };
  bool is_struct = false;
};

/// Definitions by type name, "sensor_msgs/msg/Imu".
using Definitions = std::map<std::string, Definition>;

/// Comments and preprocessor lines become blanks.
std::string without_comments(const std::string& text) {
  std::string out;
  bool line_start = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool skips_line = text.compare(i, 2, "//") == 0 || (line_start && text[i] == '#');
    if (skips_line) i = std::min(text.find('\n', i), text.size());
    if (text.compare(std::min(i, text.size()), 2, "/*") == 0) {
      i = std::min(text.find("*/", i + 2), text.size());
      i += 1;
      continue;
    }
    if (i >= text.size()) break;
    out += text[i];
    if (text[i] == '\n') {
      line_start = true;
    } else if (std::isspace(static_cast<unsigned char>(text[i])) == 0) {
      line_start = false;
    }
  }
  return out;
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Reads `module package { module msg { ... }; };` and what is inside.
class Scanner {
 public:
  explicit Scanner(const std::string& file) : text_(without_comments(file)) {}

  Status scan(Definitions& definitions) {
    while (skip_blanks()) {
      if (word() != "module") return unexpected("\"module\"");
      const std::string package = word();
      if (!take('{') || word() != "module" || word() != "msg" || !take('{')) {
        return unexpected("\"module package { module msg {\"");
      }
      while (skip_blanks() && text_[at_] != '}') {
        if (const Status done = scan_definition(package, definitions); !done.ok()) return done;
      }
      for (int i = 0; i < 2; ++i) {
        if (!take('}') || !take(';')) return unexpected("\"};\"");
      }
    }
    return {};
  }

 private:
  bool skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size();
  }

  std::string word() {
    skip_blanks();
    const std::size_t start = at_;
    while (at_ < text_.size() && is_word(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

  bool take(char c) {
    if (!skip_blanks() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  Error unexpected(const std::string& wanted) const {
    return Error{"IDL: " + wanted + " expected at \"" + text_.substr(at_, 40) + "\""};
  }

  Status scan_definition(const std::string& package, Definitions& definitions) {
    const std::size_t start = at_;
    const std::string kind = word();
    const std::string suffix = "_Constants";
    if (kind != "struct" && kind != "enum" && kind != "module" && kind != "typedef") {
      return unexpected("struct, enum, typedef or a module of constants");
    }
    std::string name = word();
    if (!skip_definition()) return unexpected("the end of " + kind + " " + name);
    const std::string body = text_.substr(start, at_ - start);
    if (kind == "typedef") name = typedef_name(body);
    const bool constants = kind == "module" && name.size() > suffix.size() &&
                           name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
    if (kind == "module" && !constants) return unexpected("a module named ..._Constants");
    if (constants) name.resize(name.size() - suffix.size());

    Definition& definition = definitions[package + "/msg/" + name];
    definition.package = package;
    definition.name = name;
    (constants ? definition.constants : definition.body) = body;
    definition.is_struct = definition.is_struct || kind == "struct";
    return {};
  }

  /// Moves behind the semicolon that ends the definition.
  bool skip_definition() {
    int depth = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == '{') ++depth;
      if (c == '}') --depth;
      if (c == ';' && depth == 0) return true;
      if (depth < 0) return false;
    }
    return false;
  }

  /// The word before the bounds: typedef double Name[9];
  static std::string typedef_name(const std::string& body) {
    std::size_t end = body.find('[');
    if (end == std::string::npos) end = body.size() - 1;
    while (end > 0 && !is_word(body[end - 1])) --end;
    std::size_t begin = end;
    while (begin > 0 && is_word(body[begin - 1])) --begin;
    return body.substr(begin, end - begin);
  }

  std::string text_;
  std::size_t at_ = 0;
};

/// Type names that the definition mentions, in their order.
std::vector<std::string> types_in(const Definition& definition, const Definitions& known) {
  std::vector<std::string> types;
  const std::string& text = definition.body;
  for (std::size_t i = 0; i < text.size();) {
    if (!is_word(text[i])) {
      ++i;
      continue;
    }
    std::string name;
    while (i < text.size() && (is_word(text[i]) || text.compare(i, 2, "::") == 0)) {
      name += text[i] == ':' ? '/' : text[i];
      i += text[i] == ':' ? 2 : 1;
    }
    for (const std::string& candidate : {name, definition.package + "/msg/" + name}) {
      if (known.count(candidate) != 0 &&
          candidate != definition.package + "/msg/" + definition.name)
        types.push_back(candidate);
    }
  }
  return types;
}

void append(const std::string& type_name, const Definitions& definitions,
            std::set<std::string>& done, std::string& schema) {
  if (!done.insert(type_name).second) return;
  const Definition& definition = definitions.at(type_name);
  schema += std::string(80, '=') + "\nIDL: " + type_name + "\n";
  schema += "module " + definition.package + " {\nmodule msg {\n";
  if (!definition.constants.empty()) schema += definition.constants + "\n";
  schema += definition.body + "\n};\n};\n";
  for (const std::string& type : types_in(definition, definitions)) {
    append(type, definitions, done, schema);
  }
}

Result<Definitions> scan_all(const std::vector<std::string>& files) {
  Definitions definitions;
  for (const std::string& file : files) {
    if (const Status done = Scanner(file).scan(definitions); !done.ok()) return done.error();
  }
  return definitions;
}

Result<std::string> schema_of(const std::string& type_name, const Definitions& definitions) {
  const auto found = definitions.find(type_name);
  if (found == definitions.end() || found->second.body.empty()) {
    return Error{"no IDL file defines " + type_name};
  }
  std::string schema;
  std::set<std::string> done;
  append(type_name, definitions, done, schema);
  return schema;
}

const Definitions& built_in() {
  static const Definitions definitions = [] {
    auto scanned = scan_all(idl_files());
    return scanned.ok() ? std::move(*scanned) : Definitions();
  }();
  return definitions;
}

}  // namespace

Result<std::string> idl_schema(const std::string& type_name) {
  return schema_of(type_name, built_in());
}

Result<std::string> idl_schema(const std::string& type_name,
                               const std::vector<std::string>& files) {
  const auto definitions = scan_all(files);
  if (!definitions.ok()) return definitions.error();
  return schema_of(type_name, *definitions);
}

const std::vector<std::string>& idl_type_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, definition] : built_in()) {
      if (definition.is_struct) all.push_back(name);
    }
    return all;
  }();
  return names;
}

}  // namespace swiftlet
