// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/type_resolver.hpp"

#include <algorithm>
#include <set>

namespace swiftlet {
namespace {

/// Larger values would not pass the middleware; a limit makes arithmetic on sizes safe.
constexpr std::uint64_t kMaxSize = 1ULL << 30;

const std::map<std::string, Primitive>& primitives() {
  static const std::map<std::string, Primitive> names{
      {"boolean", Primitive::kBoolean},
      {"char", Primitive::kUint8},
      {"octet", Primitive::kUint8},
      {"int8", Primitive::kInt8},
      {"uint8", Primitive::kUint8},
      {"int16", Primitive::kInt16},
      {"short", Primitive::kInt16},
      {"uint16", Primitive::kUint16},
      {"unsigned short", Primitive::kUint16},
      {"int32", Primitive::kInt32},
      {"long", Primitive::kInt32},
      {"uint32", Primitive::kUint32},
      {"unsigned long", Primitive::kUint32},
      {"int64", Primitive::kInt64},
      {"long long", Primitive::kInt64},
      {"uint64", Primitive::kUint64},
      {"unsigned long long", Primitive::kUint64},
      {"float", Primitive::kFloat},
      {"double", Primitive::kDouble},
  };
  return names;
}

/// Ends the resolving; it does not leave this file.
struct ResolveError {
  std::string reason;
};

[[noreturn]] void fail(const IdlDefinition& definition, const std::string& problem) {
  throw ResolveError{definition.where + ": IDL: " + definition.name + ": " + problem};
}

}  // namespace

/// Gives the names in definitions their meaning.
class TypeResolver {
 public:
  explicit TypeResolver(std::vector<IdlDefinition> definitions)
      : definitions_(std::move(definitions)) {
    for (const IdlDefinition& definition : definitions_) {
      const bool is_new = by_name_.emplace(definition.full_name(), &definition).second;
      if (!is_new && definition.kind != IdlDefinition::Kind::kModule) {
        fail(definition, "is defined twice");
      }
    }
  }

  TypeLibrary resolve() {
    for (const IdlDefinition& definition : definitions_) {
      if (definition.kind != IdlDefinition::Kind::kStruct) continue;
      TypeDescription& type = structure(definition);
      for (const IdlMember& member : definition.members) {
        type.members.push_back({member.name, type_of(definition, member, 0)});
      }
    }
    for (auto& [name, type] : library_.structs_) measure(type);
    for (const auto& type : library_.other_types_) measure(*type);
    return std::move(library_);
  }

 private:
  TypeDescription& structure(const IdlDefinition& definition) {
    const std::string name = with_slashes(definition.full_name());
    TypeDescription& type = library_.structs_[name];
    type.kind = TypeDescription::Kind::kStruct;
    type.name = name;
    return type;
  }

  /// What a name means inside of a definition: looked up from the innermost scope outwards.
  const IdlDefinition* find(const IdlDefinition& user, const std::string& name) const {
    std::string scope = user.scope;
    if (name.compare(0, 2, "::") == 0) {
      const auto found = by_name_.find(name.substr(2));
      return found == by_name_.end() ? nullptr : found->second;
    }
    for (;;) {
      const auto found = by_name_.find(scope.empty() ? name : scope + "::" + name);
      if (found != by_name_.end()) return found->second;
      if (scope.empty()) return nullptr;
      const std::size_t last = scope.rfind("::");
      scope = last == std::string::npos ? "" : scope.substr(0, last);
    }
  }

  std::uint32_t number_of(const IdlDefinition& user, const std::string& text, int depth) const {
    const bool is_number = !text.empty() && text.find_first_not_of("0123456789") == text.npos;
    if (is_number) {
      const std::uint64_t number = text.size() > 10 ? kMaxSize + 1 : std::stoull(text);
      if (number == 0 || number > kMaxSize) fail(user, text + " is no size from 1 to 2^30");
      return static_cast<std::uint32_t>(number);
    }
    const IdlDefinition* constant = depth < 8 ? find(user, text) : nullptr;
    if (constant == nullptr || constant->kind != IdlDefinition::Kind::kConstant) {
      fail(user, "'" + text + "' is neither a whole number nor a constant");
    }
    return number_of(*constant, constant->value, depth + 1);
  }

  const TypeDescription* keep(TypeDescription type) {
    library_.other_types_.push_back(std::make_unique<TypeDescription>(std::move(type)));
    return library_.other_types_.back().get();
  }

  const TypeDescription* type_of(const IdlDefinition& user, const IdlMember& member, int depth) {
    const TypeDescription* type = type_of(user, member.type, depth);
    // double x[2][3]: two arrays of three.
    for (auto size = member.dimensions.rbegin(); size != member.dimensions.rend(); ++size) {
      TypeDescription array;
      array.kind = TypeDescription::Kind::kArray;
      array.count = number_of(user, *size, 0);
      array.element = type;
      const bool nested = type->kind == TypeDescription::Kind::kArray;
      const std::string text = "[" + std::to_string(array.count) + "]";
      const std::size_t first = nested ? type->name.find('[') : type->name.size();
      array.name = std::string(type->name).insert(first, text);
      type = keep(std::move(array));
    }
    return type;
  }

  const TypeDescription* type_of(const IdlDefinition& user, const IdlType& written, int depth) {
    if (depth > 32) fail(user, "'" + written.name + "' leads to itself");
    TypeDescription type;
    type.name = written.name;
    const std::string bound =
        written.bound.empty() ? "" : std::to_string(number_of(user, written.bound, 0));
    if (!bound.empty()) type.count = static_cast<std::uint32_t>(std::stoul(bound));
    if (written.name == "string") {
      type.kind = TypeDescription::Kind::kString;
      if (!bound.empty()) type.name += "<" + bound + ">";
      return keep(std::move(type));
    }
    if (written.name == "sequence") {
      type.kind = TypeDescription::Kind::kSequence;
      type.element = type_of(user, written.element.at(0), depth + 1);
      type.name += "<" + type.element->name + (bound.empty() ? "" : ", " + bound) + ">";
      return keep(std::move(type));
    }
    const auto primitive = primitives().find(written.name);
    if (primitive != primitives().end()) {
      type.primitive = primitive->second;
      return keep(std::move(type));
    }
    const IdlDefinition* definition = find(user, written.name);
    if (definition == nullptr) fail(user, "nothing defines the type '" + written.name + "'");
    switch (definition->kind) {
      case IdlDefinition::Kind::kStruct:
        return &structure(*definition);
      case IdlDefinition::Kind::kTypedef:
        return type_of(*definition, definition->members.at(0), depth + 1);
      case IdlDefinition::Kind::kEnum:
        type.primitive = Primitive::kUint32;
        return keep(std::move(type));
      default:
        fail(user, "'" + written.name + "' is no type");
    }
  }

  /// Sets the minimum size of a type and of all that stand in it without a sequence between.
  std::size_t measure(TypeDescription& type) {
    if (type.minimum_size != 0) return type.minimum_size;
    if (!measuring_.insert(&type).second)
      throw ResolveError{"IDL: " + type.name + " contains itself"};
    std::uint64_t size = 4;  // the length of a string or sequence
    if (type.kind == TypeDescription::Kind::kPrimitive) {
      size = size_of(type.primitive);
    } else if (type.kind == TypeDescription::Kind::kArray) {
      size = std::uint64_t{type.count} * measure(own(type.element));
    } else if (type.kind == TypeDescription::Kind::kStruct) {
      size = 0;
      for (const StructMember& member : type.members) {
        size = std::min(size + measure(own(member.type)), kMaxSize + 1);
      }
    }
    if (size > kMaxSize) throw ResolveError{"IDL: " + type.name + " has more than 1 GiB"};
    measuring_.erase(&type);
    return type.minimum_size = static_cast<std::size_t>(size);
  }

  /// The library is still being made, and all types are its own.
  static TypeDescription& own(const TypeDescription* type) {
    return const_cast<TypeDescription&>(*type);
  }

  std::vector<IdlDefinition> definitions_;
  std::map<std::string, const IdlDefinition*> by_name_;
  std::set<const TypeDescription*> measuring_;
  TypeLibrary library_;
};

Result<TypeLibrary> resolve_types(std::vector<IdlDefinition> definitions) {
  try {
    return TypeResolver(std::move(definitions)).resolve();
  } catch (const ResolveError& error) {
    return Error{error.reason};
  }
}

std::string with_slashes(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool separator = name.compare(i, 2, "::") == 0;
    out += separator ? '/' : name[i];
    if (separator) ++i;
  }
  return out;
}

}  // namespace swiftlet
