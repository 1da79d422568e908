// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/config/yaml_text.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>

namespace swiftlet {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;
constexpr int kMaxDepth = 32;
constexpr int kMostValues = 100'000;  // aliases counted with all that they stand for

/// Walks through all nodes as a reader would.
class Inspection {
 public:
  void inspect(const YAML::Node& node, int depth = 0) {
    if (depth > kMaxDepth) {
      throw YamlProblem(line_of(node),
                        fmt::format("nested more than {} levels deep; is there an alias in its own "
                                    "anchor?",
                                    kMaxDepth));
    }
    if (++values_ > kMostValues) {
      throw YamlProblem(line_of(node),
                        fmt::format("more than {} values, aliases included; write less, or fewer "
                                    "aliases",
                                    kMostValues));
    }
    if (node.IsMap()) inspect_map(node, depth);
    if (node.IsSequence()) {
      for (const YAML::Node& item : node) inspect(item, depth + 1);
    }
  }

 private:
  /// yaml-cpp keeps both of two equal keys and finds one; YAML 1.2 forbids them.
  void inspect_map(const YAML::Node& map, int depth) {
    std::set<std::string> keys;
    for (const auto& entry : map) {
      if (entry.first.IsScalar() && !keys.insert(entry.first.Scalar()).second) {
        throw YamlProblem(line_of(entry.first),
                          fmt::format("'{}' is given twice; keep one", entry.first.Scalar()));
      }
      inspect(entry.second, depth + 1);
    }
  }

  int values_ = 0;
};

}  // namespace

int line_of(const YAML::Node& node) {
  return node.IsDefined() ? std::max(1, node.Mark().line + 1) : 1;
}

YAML::Node parse_yaml(const std::string& text) {
  if (text.size() > kMostBytes) {
    throw YamlProblem(
        1, fmt::format("has {} bytes; a configuration has at most {}", text.size(), kMostBytes));
  }
  try {
    const YAML::Node top = YAML::Load(text);
    Inspection().inspect(top);
    return top;
  } catch (const YAML::Exception& error) {
    throw YamlProblem(std::max(1, error.mark.line + 1), "not valid YAML: " + error.msg);
  }
}

}  // namespace swiftlet
