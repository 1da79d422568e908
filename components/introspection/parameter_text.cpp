// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/parameter_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace swiftlet {
namespace {

using Json = nlohmann::ordered_json;
using swiftlet_msgs::msg::Parameter;
using namespace swiftlet_msgs::msg::Parameter_Constants;

/// Mappings in the order in which their keys came.
struct Mapping {
  std::vector<std::pair<std::string, Mapping>> below;
  std::string value;

  Mapping& at(const std::string& key) {
    for (auto& [name, mapping] : below) {
      if (name == key) return mapping;
    }
    return below.emplace_back(key, Mapping()).second;
  }
};

void set(Mapping& mapping, const std::string& path, const std::string& value) {
  const std::size_t dot = path.find('.');
  if (dot == std::string::npos) {
    mapping.at(path).value = value;
  } else {
    set(mapping.at(path.substr(0, dot)), path.substr(dot + 1), value);
  }
}

/// On one line: a line break in a value would end it.
std::string one_line(const std::string& value) {
  if (value.find('\n') == std::string::npos) return value;
  return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write(const Mapping& mapping, std::size_t indent, std::string& text) {
  for (const auto& [key, below] : mapping.below) {
    text.append(indent, ' ');
    if (below.below.empty()) {
      text += fmt::format("{}: {}\n", key, one_line(below.value));
    } else {
      text += key + ":\n";
      write(below, indent + 2, text);
    }
  }
}

/// When it may be set.
const char* changes_text(const Parameter& parameter) {
  if (parameter.changes() == AT_ANY_TIME) return "at any time";
  return parameter.changes() == ON_GROUND ? "on ground" : "at start";
}

bool same_values(const std::vector<Parameter>& a, const std::vector<Parameter>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Parameter& one, const Parameter& other) {
                      return one.name() == other.name() && one.value() == other.value();
                    });
}

}  // namespace

std::string parameters_text(const ParameterReplies& replies) {
  std::string text;
  for (const auto& reply : replies) {
    text += fmt::format("{} ({}):\n", reply.component_name(), reply.process());
    for (const Parameter& parameter : reply.parameters()) {
      text += fmt::format(
          "  {:32} {:24} {}{}{}\n", parameter.name(), parameter.value(), parameter.type(),
          parameter.limits().empty() ? "" : ", " + parameter.limits(),
          parameter.changes() == AT_START ? "" : fmt::format(", {}", changes_text(parameter)));
    }
    if (reply.parameters().empty()) text += "  none\n";
  }
  return text;
}

Json parameters_json(const ParameterReplies& replies) {
  Json array = Json::array();
  for (const auto& reply : replies) {
    Json parameters = Json::array();
    for (const Parameter& parameter : reply.parameters()) {
      parameters.push_back({{"name", parameter.name()},
                            {"type", parameter.type()},
                            {"value", parameter.value()},
                            {"limits", parameter.limits()},
                            {"changes", changes_text(parameter)}});
    }
    array.push_back({{"component", reply.component_name()},
                     {"process", reply.process()},
                     {"accepted", reply.accepted()},
                     {"reason", reply.reason()},
                     {"parameters", parameters}});
  }
  return array;
}

std::string parameters_yaml(const ParameterReplies& replies, std::vector<std::string>& differing) {
  std::map<std::string, const std::vector<Parameter>*> known;
  std::string text;
  for (const auto& reply : replies) {
    const auto [place, is_new] = known.emplace(reply.component_name(), &reply.parameters());
    if (!is_new) {
      if (!same_values(*place->second, reply.parameters())) {
        differing.push_back(reply.component_name());
      }
      continue;
    }
    Mapping section;
    for (const Parameter& parameter : reply.parameters()) {
      set(section, parameter.name(), parameter.value());
    }
    text += reply.component_name() + (section.below.empty() ? ": {}\n" : ":\n");
    write(section, 2, text);
  }
  return text;
}

}  // namespace swiftlet
