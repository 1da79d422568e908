// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/topic_selection.hpp"

#include <algorithm>

#include "components/runtime/config/config.hpp"
#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

/// What remains when each wildcard is taken as a letter must be a name.
void check_glob(const std::string& text) {
  std::string name = without_slash(text);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '*' || c == '?'; }, 'x');
  const Status valid = check_name(name);
  if (valid.ok()) return;
  throw ConfigError("no topic has such a name: " + valid.error().reason +
                    "; patterns have '*', '**' and '?', for others there is --regex");
}

template <class Patterns>
bool any_matches(const Patterns& patterns, const std::string& topic) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const auto& pattern) { return std::regex_match(topic, pattern.regex); });
}

}  // namespace

std::string without_slash(const std::string& topic) {
  return !topic.empty() && topic[0] == '/' ? topic.substr(1) : topic;
}

TopicSelection::Pattern TopicSelection::glob(const std::string& text) {
  check_glob(text);
  const std::string name = without_slash(text);
  std::string regex;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == '?') {
      regex += "[^/]";
    } else if (name[i] != '*') {
      regex += name[i];
    } else if (i + 1 < name.size() && name[i + 1] == '*') {
      regex += ".*";
      ++i;
    } else {
      regex += "[^/]*";
    }
  }
  return {text, std::regex(regex)};
}

TopicSelection::TopicSelection(const TopicPatterns& patterns) {
  for (const std::string& text : patterns.topics) wanted_.push_back(glob(text));
  for (const std::string& text : patterns.exclude) excluded_.push_back(glob(text));
  for (const std::string& text : patterns.regexes) {
    try {
      wanted_.push_back({text, std::regex(without_slash(text))});
    } catch (const std::regex_error& error) {
      throw ConfigError("'" + text + "' is no regular expression: " + error.what());
    }
  }
}

bool TopicSelection::wants(const std::string& topic) const {
  const std::string name = without_slash(topic);
  return (wanted_.empty() || any_matches(wanted_, name)) && !any_matches(excluded_, name);
}

std::vector<std::string> TopicSelection::missing(const std::vector<std::string>& topics) const {
  std::vector<std::string> missing;
  for (const Pattern& pattern : wanted_) {
    const bool found = std::any_of(topics.begin(), topics.end(), [&](const std::string& topic) {
      return std::regex_match(without_slash(topic), pattern.regex);
    });
    if (!found) missing.push_back(pattern.text);
  }
  return missing;
}

}  // namespace swiftlet
