// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/idl_parser.hpp"

#include <algorithm>

#include "components/runtime/reflection/idl_lexer.hpp"

namespace swiftlet {
namespace {

using Kind = IdlDefinition::Kind;

constexpr int kMaxDepth = 32;  // of modules and sequences in each other

/// Ends the parsing; it does not leave this file.
struct SyntaxError {
  std::string reason;
};

class Parser {
 public:
  explicit Parser(const IdlFile& file)
      : file_(file.name), text_(without_comments(file.text)), tokens_(idl_tokens(text_)) {}

  std::vector<IdlDefinition> parse() {
    while (!token().text.empty()) parse_definition("", 0);
    return std::move(definitions_);
  }

 private:
  const IdlToken& token() const { return tokens_[at_]; }
  bool next_is(const std::string& text) const { return token().text == text; }

  bool take(const std::string& text) {
    if (!next_is(text)) return false;
    ++at_;
    return true;
  }

  void expect(const std::string& text) {
    if (!take(text)) fail("'" + text + "' expected");
  }

  std::string where(std::size_t position) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(position);
    return file_ + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n'));
  }

  [[noreturn]] void fail(const std::string& problem) const {
    const std::string found =
        token().text.empty() ? "the end of the file" : "'" + token().text + "'";
    throw SyntaxError{where(token().begin) + ": IDL: " + problem + " before " + found};
  }

  std::string take_word(const std::string& what) {
    if (!token().is_word) fail(what + " expected");
    return tokens_[at_++].text;
  }

  /// A name that is defined here. A leading underscore only says that it is no keyword.
  std::string take_identifier(const std::string& what) {
    const std::string word = take_word(what);
    return word[0] == '_' ? word.substr(1) : word;
  }

  void skip_annotations() {
    while (take("@")) {
      take_scoped_name();
      if (!take("(")) continue;
      for (int depth = 1; depth > 0; ++at_) {
        if (token().text.empty()) fail("')' expected");
        if (next_is("(")) ++depth;
        if (next_is(")")) --depth;
      }
    }
  }

  std::string take_scoped_name() {
    std::string name = take("::") ? "::" : "";
    name += take_identifier("a name");
    while (take("::")) name += "::" + take_identifier("a name");
    return name;
  }

  /// A literal or the name of a constant; expressions are not supported.
  std::string take_value() {
    std::string value;
    if (next_is("-") || next_is("+")) value = tokens_[at_++].text;
    if (token().is_word || next_is("::")) {
      value += take_scoped_name();
    } else {
      if (token().text.empty() ||
          std::string("{}()[]<>;,=@:").find(token().text) != std::string::npos)
        fail("a value expected");
      value += tokens_[at_++].text;
    }
    return value;
  }

  IdlType take_type(int depth) {
    if (depth > kMaxDepth) fail("fewer sequences in each other expected");
    skip_annotations();
    IdlType type;
    if (take("sequence")) {
      type.name = "sequence";
      expect("<");
      type.element.push_back(take_type(depth + 1));
      if (take(",")) type.bound = take_value();
      expect(">");
      return type;
    }
    for (const char* unknown : {"map", "wstring", "wchar", "fixed", "any", "union"}) {
      if (next_is(unknown))
        fail("a type that this parser supports (no " + token().text + ") expected");
    }
    type.name = take_scoped_name();
    if (type.name == "string" && take("<")) {
      type.bound = take_value();
      expect(">");
    } else if (type.name == "unsigned") {
      type.name += " " + take_word("short or long");
    }
    if ((type.name == "long" || type.name == "unsigned long") && take("long")) type.name += " long";
    if (type.name == "long" && next_is("double")) fail("a type other than long double expected");
    return type;
  }

  /// What stands behind a type: names with dimensions, with commas between.
  void take_declarators(const IdlType& type, std::vector<IdlMember>& members) {
    do {
      skip_annotations();
      IdlMember member{type, take_identifier("a name"), {}};
      while (take("[")) {
        member.dimensions.push_back(take_value());
        expect("]");
      }
      members.push_back(std::move(member));
    } while (take(","));
    expect(";");
  }

  void parse_definition(const std::string& scope, int depth) {
    if (depth > kMaxDepth) fail("fewer modules in each other expected");
    skip_annotations();
    const std::size_t begin = token().begin;
    const std::size_t index = definitions_.size();
    definitions_.emplace_back();
    IdlDefinition definition;
    definition.scope = scope;
    definition.where = where(begin);
    if (take("module")) {
      definition.kind = Kind::kModule;
      definition.name = take_identifier("the name of a module");
      expect("{");
      while (!next_is("}")) parse_definition(definition.full_name(), depth + 1);
      expect("}");
      expect(";");
    } else if (take("struct")) {
      parse_struct(definition);
    } else if (take("enum")) {
      parse_enum(definition);
    } else if (take("typedef")) {
      definition.kind = Kind::kTypedef;
      take_declarators(take_type(0), definition.members);
      if (definition.members.size() != 1) fail("one name in a typedef expected");
      definition.name = definition.members[0].name;
    } else if (take("const")) {
      definition.kind = Kind::kConstant;
      take_type(0);
      definition.name = take_identifier("the name of a constant");
      expect("=");
      definition.value = take_value();
      expect(";");
    } else {
      fail("module, struct, enum, typedef or const expected");
    }
    definition.text = text_.substr(begin, tokens_[at_ - 1].end - begin);
    definitions_[index] = std::move(definition);
  }

  void parse_struct(IdlDefinition& definition) {
    definition.kind = Kind::kStruct;
    definition.name = take_identifier("the name of a struct");
    if (next_is(":")) fail("a struct without a base expected");
    expect("{");
    while (!take("}")) {
      const IdlType type = take_type(0);
      take_declarators(type, definition.members);
    }
    if (definition.members.empty()) fail("a member of " + definition.name + " expected");
    expect(";");
  }

  void parse_enum(IdlDefinition& definition) {
    definition.kind = Kind::kEnum;
    definition.name = take_identifier("the name of an enum");
    expect("{");
    do {
      skip_annotations();
      take_identifier("a value of " + definition.name);
    } while (take(","));
    expect("}");
    expect(";");
  }

  std::string file_;
  std::string text_;
  std::vector<IdlToken> tokens_;
  std::size_t at_ = 0;
  std::vector<IdlDefinition> definitions_;
};

}  // namespace

Result<std::vector<IdlDefinition>> parse_idl(const IdlFile& file) {
  try {
    return Parser(file).parse();
  } catch (const SyntaxError& error) {
    return Error{error.reason};
  }
}

}  // namespace swiftlet
