// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/field_path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

using Kind = TypeDescription::Kind;

Error unknown_member(const TypeDescription& type, const std::string& path,
                     const std::string& name) {
  std::vector<std::string> known;
  for (const StructMember& member : type.members) known.push_back(member.name);
  const std::string near = nearest_word(name, known);
  return Error{fmt::format("field '{}': {} has no '{}'; {}", path, type.name, name,
                           near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                                        : fmt::format("did you mean '{}'?", near))};
}

}  // namespace

Result<FieldPath> FieldPath::parse(const TypeDescription& root, const std::string& text) {
  FieldPath path;
  const TypeDescription* type = &root;
  for (std::size_t at = 0; at < text.size();) {
    const bool index = text[at] == '[';
    const std::size_t end =
        index ? text.find(']', at) : std::min(text.find_first_of(".[", at), text.size());
    if (end == std::string::npos) return Error{fmt::format("field '{}': ']' is missing", text)};
    const std::string step = text.substr(at + (index ? 1 : 0), end - at - (index ? 1 : 0));
    if (index) {
      const bool is_number = !step.empty() && step.size() < 10 &&
                             step.find_first_not_of("0123456789") == std::string::npos;
      if (!is_number) {
        return Error{fmt::format("field '{}': '{}' is no number of an element", text, step)};
      }
      const bool list = type->kind == Kind::kArray || type->kind == Kind::kSequence;
      if (!list) return Error{fmt::format("field '{}': a {} has no elements", text, type->name)};
      const std::size_t number = std::stoul(step);
      if (type->count != 0 && number >= type->count) {
        return Error{fmt::format("field '{}': a {} has no element {}", text, type->name, number)};
      }
      path.steps_.push_back(number);
      type = type->element;
    } else {
      const auto member = std::find_if(type->members.begin(), type->members.end(),
                                       [&](const StructMember& m) { return m.name == step; });
      if (type->kind != Kind::kStruct) {
        return Error{fmt::format("field '{}': a {} has no parts with names", text, type->name)};
      }
      if (member == type->members.end()) return unknown_member(*type, text, step);
      path.steps_.push_back(static_cast<std::size_t>(member - type->members.begin()));
      type = member->type;
    }
    at = index ? end + 1 : end;
    path.names_.push_back(text.substr(0, at));
    if (at < text.size() && text[at] == '.') {
      ++at;
      if (at == text.size()) return Error{fmt::format("field '{}': ends with '.'", text)};
    } else if (at < text.size() && text[at] != '[') {
      return Error{fmt::format("field '{}': '.' is missing behind ']'", text)};
    }
  }
  return path;
}

Result<Value> FieldPath::select(const Value& message) const {
  Value value = message;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (steps_[i] >= value.size()) {
      return Error{fmt::format("there is no {}: {} elements", names_[i], value.size())};
    }
    value = value.at(steps_[i]);
  }
  return value;
}

}  // namespace swiftlet
