// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/value_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "components/runtime/utf8.hpp"

namespace swiftlet {
namespace {

using Kind = TypeDescription::Kind;

/// The shortest text that reads as the same number, and as a floating-point one.
template <class Float>
std::string number_text(Float number) {
  if (std::isnan(number)) return ".nan";
  if (std::isinf(number)) return number > 0 ? ".inf" : "-.inf";
  std::string text = fmt::format("{}", number);
  if (text.find('.') != std::string::npos) return text;
  // YAML 1.1 takes 1e-05 for a text, but not 1.0e-05.
  const std::size_t exponent = text.find('e');
  return text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
}

bool is_plain(const std::string& text) {
  static const std::set<std::string> words{"true", "false", "yes", "no", "on",  "off",
                                           "null", "y",     "n",   "~",  "nan", "inf"};
  std::string lower;
  for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool begins = !text.empty() && (std::isalpha(static_cast<unsigned char>(text[0])) != 0 ||
                                        text[0] == '_' || text[0] == '/');
  const std::string allowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_/.-+ ";
  return begins && text.back() != ' ' && words.count(lower) == 0 &&
         text.find_first_not_of(allowed) == std::string::npos;
}

/// A text as YAML has it. What is not plain is quoted as in JSON, which YAML reads, too.
std::string quoted(const std::string& text) {
  if (is_plain(text)) return text;
  if (text.empty()) return "''";
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string cut(const std::string& text, std::size_t longest) {
  if (longest == 0 || text.size() <= longest) return text;
  return text.substr(0, utf8_cut(text, longest)) + "...";
}

std::string scalar_text(const Value& value, std::size_t longest) {
  struct Visitor {
    std::size_t longest;
    std::string operator()(bool truth) const { return truth ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(std::uint64_t number) const { return fmt::format("{}", number); }
    std::string operator()(float number) const { return number_text(number); }
    std::string operator()(double number) const { return number_text(number); }
    std::string operator()(const std::string& text) const { return quoted(cut(text, longest)); }
    std::string operator()(const Value::Numbers&) const { return ""; }
    std::string operator()(const Value::Parts&) const { return ""; }
  };
  return std::visit(Visitor{longest}, value.content);
}

/// "sequence<float> of 360", and "double[9]".
std::string list_text(const Value& list) {
  const bool array = list.type->kind == Kind::kArray;
  return array ? list.type->name : fmt::format("{} of {}", list.type->name, list.size());
}

/// Writes what stands behind "name:" or "-".
class YamlWriter {
 public:
  explicit YamlWriter(const TextOptions& options) : options_(options) {}

  /// `indent` blanks stand before each line but the first, which goes on where the text ends.
  void write(const Value& value, std::size_t indent) {
    if (value.type->kind == Kind::kStruct) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (i > 0) text_.append(indent, ' ');
        text_ += value.type->members[i].name + ":";
        write_below(value.at(i), indent);
      }
    } else if (!value.is_list()) {
      text_ += scalar_text(value, options_.longest) + "\n";
    } else if (!options_.lists) {
      text_ += "'<" + list_text(value) + ">'\n";
    } else {
      write_list(value, indent);
    }
  }

  std::string take() { return std::move(text_); }

 private:
  void write_below(const Value& value, std::size_t indent) {
    const bool list = value.is_list() && options_.lists && value.size() > 0;
    if (value.type->kind == Kind::kStruct) {
      text_ += "\n" + std::string(indent + 2, ' ');
      write(value, indent + 2);
    } else if (list) {
      text_ += "\n" + std::string(indent, ' ');
      write(value, indent);
    } else {
      text_ += " ";
      write(value, indent);
    }
  }

  void write_list(const Value& list, std::size_t indent) {
    if (list.size() == 0) text_ += "[]\n";
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i > 0) text_.append(indent, ' ');
      text_ += "- ";
      if (options_.longest != 0 && i == options_.longest) {
        text_ += "'...'\n";
        return;
      }
      write(list.at(i), indent + 2);
    }
  }

  TextOptions options_;
  std::string text_;
};

template <class Float>
nlohmann::ordered_json json_number(Float number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
  // 0.1, not the 0.10000000149011612 that a float of that name is.
  return std::strtod(fmt::format("{}", number).c_str(), nullptr);
}

}  // namespace

std::string to_yaml(const Value& value, const TextOptions& options) {
  YamlWriter writer(options);
  writer.write(value, 0);
  return writer.take();
}

std::string to_line(const Value& value) {
  if (value.type->kind == Kind::kStruct) return value.type->name;
  return value.is_list() ? list_text(value) : scalar_text(value, 0);
}

nlohmann::ordered_json to_json(const Value& value, bool lists) {
  using Json = nlohmann::ordered_json;
  if (value.type->kind == Kind::kStruct) {
    Json object = Json::object();
    for (std::size_t i = 0; i < value.size(); ++i) {
      object[value.type->members[i].name] = to_json(value.at(i), lists);
    }
    return object;
  }
  if (value.is_list()) {
    if (!lists) return list_text(value);
    Json array = Json::array();
    for (std::size_t i = 0; i < value.size(); ++i) array.push_back(to_json(value.at(i), lists));
    return array;
  }
  struct Visitor {
    Json operator()(bool truth) const { return truth; }
    Json operator()(std::int64_t number) const { return number; }
    Json operator()(std::uint64_t number) const { return number; }
    Json operator()(float number) const { return json_number(number); }
    Json operator()(double number) const { return json_number(number); }
    Json operator()(const std::string& text) const { return text; }
    Json operator()(const Value::Numbers&) const { return nullptr; }
    Json operator()(const Value::Parts&) const { return nullptr; }
  };
  return std::visit(Visitor{}, value.content);
}

}  // namespace swiftlet
