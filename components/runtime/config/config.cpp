// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/config/config.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "components/runtime/config/yaml_text.hpp"

namespace swiftlet {

/// What the mappings of one file share: its name, its content, and the keys that were asked for.
struct Config::File {
  std::string name;
  std::filesystem::path folder;
  YAML::Node top;
  std::map<std::string, std::set<std::string>> known;  // by path of the mapping
  std::map<std::string, YAML::Node> set_by_hand;       // by path of the value
  std::vector<ConfigEntry> entries;                    // paths from the top
};

namespace {

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "empty";
  return fmt::format("'{}'", node.Scalar());
}

/// Whether the whole scalar is a number of the language's own form.
bool to_number(const YAML::Node& node, double& value) {
  if (!node.IsScalar() || node.Tag() == "!") return false;
  return YAML::convert<double>::decode(node, value);
}

std::string describe(Range range) {
  const Range all;
  if (range.min == all.min && range.max == all.max) return "";
  if (range.min == all.min) return fmt::format("at most {}", range.max);
  if (range.max == all.max) {
    return range.min == kPositive.min ? "positive" : fmt::format("at least {}", range.min);
  }
  return fmt::format("from {} to {}", range.min, range.max);
}

/// As it stands in a file. Numbers have the shortest form that reads as the same value.
std::string to_yaml(double value) {
  return fmt::format("{}", value);
}
std::string to_yaml(const std::string& value) {
  YAML::Emitter text;
  text << value;
  return text.c_str();
}
std::string to_yaml(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}
std::string to_yaml(const std::vector<std::string>& values) {
  YAML::Emitter text;  // which knows what must be quoted within brackets
  text << YAML::Flow << values;
  return text.c_str();
}

YAML::Node mapping_to_nothing(const YAML::Node& key) {
  YAML::Node mapping(YAML::NodeType::Map);
  mapping.force_insert(key, YAML::Node());
  return mapping;
}

std::string join_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

std::string item_path(const std::string& path, const std::string& key, std::size_t index) {
  return fmt::format("{}[{}]", join_path(path, key), index);
}

}  // namespace

Config::Config() : Config(std::make_shared<File>(), "", YAML::Node(YAML::NodeType::Map)) {}
Config::Config(std::shared_ptr<File> file, std::string path, const YAML::Node& node)
    : file_(std::move(file)), path_(std::move(path)), node_(std::make_shared<YAML::Node>(node)) {}

Config Config::load(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw ConfigError(
        fmt::format("{}: cannot be read; check the path and its permissions", file.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  Config config = parse(text.str(), file.string());
  config.file_->folder = file.parent_path();
  return config;
}

Config Config::parse(const std::string& yaml, const std::string& name) {
  auto file = std::make_shared<File>();
  file->name = name;
  try {
    file->top = parse_yaml(yaml);
  } catch (const YamlProblem& problem) {
    throw ConfigError(fmt::format("{}:{}: {}", name, problem.line(), problem.what()));
  }
  if (file->top.IsNull()) file->top = YAML::Node(YAML::NodeType::Map);
  if (!file->top.IsMap()) {
    throw ConfigError(
        fmt::format("{}:1: expected a mapping 'key: value', found {}", name, kind_of(file->top)));
  }
  return Config(file, "", file->top);
}

void Config::set(const std::string& path, const std::string& value) {
  try {
    file_->set_by_hand[join_path(path_, path)] = parse_yaml(value);
  } catch (const YamlProblem& problem) {
    throw ConfigError(fmt::format("{}={}: {}", path, value, problem.what()));
  }
}

Config Config::with(const std::string& key, const std::string& value) const {
  auto file = std::make_shared<File>(*file_);
  file->known.clear();
  file->entries.clear();
  Config copy(file, path_, *node_);
  copy.set(key, value);
  return copy;
}

bool Config::has(const std::string& key) const {
  return find(key).IsDefined();
}
bool Config::empty() const {
  return node_->size() == 0;
}

std::vector<std::string> Config::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : *node_) keys.push_back(entry.first.Scalar());
  return keys;
}

YAML::Node Config::find(const std::string& key) const {
  file_->known[path_].insert(key);
  const auto by_hand = file_->set_by_hand.find(join_path(path_, key));
  if (by_hand != file_->set_by_hand.end()) return by_hand->second;
  const YAML::Node& node = *node_;
  return node[key];
}

void Config::note(const std::string& key, const char* type, const std::string& value,
                  const std::string& limits) const {
  const std::string path = join_path(path_, key);
  for (ConfigEntry& entry : file_->entries) {
    if (entry.path != path) continue;
    entry = {path, type, value, limits};
    return;
  }
  file_->entries.push_back({path, type, value, limits});
}

std::vector<ConfigEntry> Config::entries() const {
  const std::string prefix = path_.empty() ? "" : path_ + ".";
  std::vector<ConfigEntry> entries;
  for (const ConfigEntry& entry : file_->entries) {
    if (entry.path.compare(0, prefix.size(), prefix) != 0) continue;
    entries.push_back(entry);
    entries.back().path.erase(0, prefix.size());
  }
  return entries;
}

std::string Config::dump() const {
  YAML::Node top(YAML::NodeType::Map);
  for (const ConfigEntry& entry : entries()) {
    if (entry.path.find('[') != std::string::npos) continue;  // within a list of mappings
    YAML::Node node = top;
    std::size_t begin = 0;
    for (std::size_t dot = entry.path.find('.'); dot != std::string::npos;
         begin = dot + 1, dot = entry.path.find('.', begin)) {
      node.reset(node[entry.path.substr(begin, dot - begin)]);
    }
    node[entry.path.substr(begin)] = YAML::Load(entry.value);
  }
  YAML::Emitter text;
  text << top;
  return text.c_str();
}

void Config::read(const std::string& key, bool& value) const {
  const YAML::Node node = find(key);
  if (node.IsDefined() && (!node.IsScalar() || !YAML::convert<bool>::decode(node, value))) {
    fail(key, fmt::format("'{}' must be true or false, not {}", key, kind_of(node)));
  }
  note(key, "bool", value ? "true" : "false", "");
}

void Config::read(const std::string& key, int& value, Range range) const {
  double number = value;
  read(key, number, range);
  if (number != std::floor(number) || std::abs(number) > 2e9) {
    fail(key, fmt::format("'{}' must be a whole number, not {}", key, number));
  }
  value = static_cast<int>(number);
  note(key, "int", std::to_string(value), describe(range));
}

void Config::read(const std::string& key, double& value, Range range) const {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return note(key, "double", to_yaml(value), describe(range));
  double number = 0.0;
  if (!to_number(node, number)) {
    fail(key, fmt::format("'{}' must be a number, not {}", key, kind_of(node)));
  }
  if (!std::isfinite(number)) {
    fail(key, fmt::format("'{}' must be a finite number, not {}", key, kind_of(node)));
  }
  if (number < range.min || number > range.max) {
    fail(key, fmt::format("'{}' must be {}, not {}", key, describe(range), number));
  }
  value = number;
  note(key, "double", to_yaml(value), describe(range));
}

void Config::read(const std::string& key, std::string& value) const {
  const YAML::Node node = find(key);
  if (node.IsDefined()) {
    if (!node.IsScalar()) fail(key, fmt::format("'{}' must be a text, not {}", key, kind_of(node)));
    value = node.Scalar();
  }
  note(key, "string", to_yaml(value), "");
}

void Config::read(const std::string& key, std::vector<double>& value, Range range) const {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return note(key, "double[]", to_yaml(value), describe(range));
  if (!node.IsSequence()) {
    fail(key, fmt::format("'{}' must be a list of numbers, not {}", key, kind_of(node)));
  }
  std::vector<double> numbers;
  for (const YAML::Node& item : node) {
    double number = 0.0;
    if (!to_number(item, number) || !std::isfinite(number)) {
      fail(key, fmt::format("'{}' must hold finite numbers, not {}", key, kind_of(item)));
    }
    if (number < range.min || number > range.max) {
      fail(key, fmt::format("each of '{}' must be {}, not {}", key, describe(range), number));
    }
    numbers.push_back(number);
  }
  value = std::move(numbers);
  note(key, "double[]", to_yaml(value), describe(range));
}

void Config::read(const std::string& key, std::vector<std::string>& value) const {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return note(key, "string[]", to_yaml(value), "");
  if (!node.IsSequence()) {
    fail(key, fmt::format("'{}' must be a list of texts, not {}", key, kind_of(node)));
  }
  std::vector<std::string> texts;
  for (const YAML::Node& item : node) {
    if (!item.IsScalar())
      fail(key, fmt::format("'{}' must hold texts, not {}", key, kind_of(item)));
    texts.push_back(item.Scalar());
  }
  value = std::move(texts);
  note(key, "string[]", to_yaml(value), "");
}

namespace {

template <class Vector>
void read_vector(const Config& config, const std::string& key, Vector& value, Range range) {
  std::vector<double> numbers(value.data(), value.data() + value.size());
  config.read(key, numbers, range);
  if (numbers.size() != static_cast<std::size_t>(value.size())) {
    config.fail(
        key, fmt::format("'{}' must have {} numbers, not {}", key, value.size(), numbers.size()));
  }
  std::copy(numbers.begin(), numbers.end(), value.data());
}

}  // namespace

void Config::read(const std::string& key, Eigen::Vector2d& value, Range range) const {
  read_vector(*this, key, value, range);
}
void Config::read(const std::string& key, Eigen::Vector3d& value, Range range) const {
  read_vector(*this, key, value, range);
}

Config Config::child(const std::string& key) const {
  const YAML::Node node = find(key);
  const bool given = node.IsDefined() && !node.IsNull();
  if (given && !node.IsMap()) {
    fail(key, fmt::format("'{}' must be a mapping, not {}", key, kind_of(node)));
  }
  file_->known[join_path(path_, key)];
  return Config(file_, join_path(path_, key), given ? node : YAML::Node(YAML::NodeType::Map));
}

std::vector<Config> Config::list(const std::string& key) const {
  std::vector<Config> items;
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return items;
  if (!node.IsSequence()) fail(key, fmt::format("'{}' must be a list, not {}", key, kind_of(node)));
  for (const YAML::Node& item : node) {
    if (!item.IsMap()) {
      fail(key, fmt::format("each of '{}' must be a mapping, not {}", key, kind_of(item)));
    }
    const std::string path = item_path(path_, key, items.size());
    file_->known[path];
    items.push_back(Config(file_, path, item));
  }
  return items;
}

std::vector<Config> Config::steps(const std::string& key) const {
  std::vector<Config> steps;
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return steps;
  if (!node.IsSequence()) fail(key, fmt::format("'{}' must be a list, not {}", key, kind_of(node)));
  for (const YAML::Node& item : node) {
    const YAML::Node step = item.IsScalar() ? mapping_to_nothing(item) : YAML::Node(item);
    if (!step.IsMap()) {
      throw ConfigError(fmt::format("{}:{}: each of '{}' must be a mapping or a word, not {}",
                                    file_->name, line_of(item), key, kind_of(item)));
    }
    const std::string path = item_path(path_, key, steps.size());
    file_->known[path];
    steps.push_back(Config(file_, path, step));
  }
  return steps;
}

void Config::demand(const std::string& key) const {
  if (!has(key)) fail({}, fmt::format("'{}' is missing; add it", key));
}

std::string Config::where(const std::string& key) const {
  const auto by_hand = file_->set_by_hand.find(join_path(path_, key));
  if (by_hand != file_->set_by_hand.end()) {
    return fmt::format("{}={}", by_hand->first, YAML::Dump(by_hand->second));
  }
  return fmt::format("{}:{}", file_->name, line(key));
}

int Config::line(const std::string& key) const {
  // One that was made of a word has no line of its own.
  const bool is_made = node_->Mark().is_null() && node_->size() > 0;
  int line = line_of(is_made ? node_->begin()->first : *node_);
  for (const auto& entry : *node_) {
    if (entry.first.Scalar() == key) line = line_of(entry.first);
  }
  return line;
}

void Config::fail(const std::string& key, const std::string& problem) const {
  const std::string place = path_.empty() ? "" : fmt::format("in '{}': ", path_);
  throw ConfigError(fmt::format("{}: {}{}", where(key), place, problem));
}

namespace {

[[noreturn]] void fail_unknown(const Config& config, const std::string& key,
                               const std::set<std::string>& known) {
  const std::string near = nearest_word(key, {known.begin(), known.end()});
  config.fail(key,
              fmt::format("unknown key '{}'; {}", key,
                          near.empty() ? fmt::format("known keys are {}", fmt::join(known, ", "))
                                       : fmt::format("did you mean '{}'?", near)));
}

}  // namespace

std::string Config::only_key(const std::vector<std::string>& known) const {
  const std::vector<std::string> found = keys();
  for (const std::string& key : found) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      fail_unknown(*this, key, {known.begin(), known.end()});
    }
  }
  if (found.size() != 1) {
    fail({}, fmt::format("expected one of {}, found {}", fmt::join(known, ", "),
                         found.empty() ? "none" : fmt::format("{}", fmt::join(found, " and "))));
  }
  find(found.front());
  return found.front();
}

void Config::require_nothing(const std::string& key) const {
  const YAML::Node node = find(key);
  if (!node.IsDefined() || node.IsNull()) return;
  fail(key, fmt::format("'{}' takes no value, not {}; write '{}' alone", key, kind_of(node), key));
}

void Config::finish() const {
  for (const auto& [path, node] : file_->set_by_hand) {
    const std::size_t dot = path.rfind('.');
    const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
    const std::string key = path.substr(dot == std::string::npos ? 0 : dot + 1);
    const std::set<std::string>& known = file_->known[parent];
    if (known.count(key) == 0) fail_unknown(Config(file_, parent, *node_), key, known);
  }
  std::vector<Config> pending{Config(file_, "", file_->top)};
  while (!pending.empty()) {
    const Config config = pending.back();
    pending.pop_back();
    const std::set<std::string>& asked = file_->known[config.path_];
    for (const auto& entry : *config.node_) {
      const std::string key = entry.first.Scalar();
      if (asked.count(key) == 0) fail_unknown(config, key, asked);
      // Only mappings that somebody reads have known keys.
      const auto add = [&](const std::string& path, const YAML::Node& node) {
        if (node.IsMap() && file_->known.count(path) != 0) pending.push_back({file_, path, node});
      };
      add(join_path(config.path_, key), entry.second);
      for (std::size_t i = 0; entry.second.IsSequence() && i < entry.second.size(); ++i) {
        add(item_path(config.path_, key, i), entry.second[i]);
      }
    }
  }
}

std::filesystem::path Config::folder() const {
  return file_->folder;
}

}  // namespace swiftlet
