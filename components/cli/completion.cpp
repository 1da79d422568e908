// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/cli/completion.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "components/runtime/component.hpp"
#include "gcs/verbs/mode_names.hpp"

namespace swiftlet {
namespace {

const CLI::App* find_verb(const CLI::App& group, const std::string& name) {
  for (const CLI::App* verb : group.get_subcommands([](const CLI::App*) { return true; })) {
    if (verb->check_name(name)) return verb;
  }
  return nullptr;
}

/// Whether the next word is the option's.
bool takes_value(const CLI::App& verb, const std::string& name) {
  if (name.find('=') != std::string::npos) return false;
  const CLI::Option* option = verb.get_option_no_throw(name);
  return option != nullptr && option->get_expected_max() > 0;
}

/// A verb is hidden where it has no group.
void add_verbs(const CLI::App& group, std::vector<std::string>& names) {
  for (const CLI::App* verb : group.get_subcommands([](const CLI::App*) { return true; })) {
    if (!verb->get_group().empty()) names.push_back(verb->get_name());
  }
}

void add_options(const CLI::App& verb, std::vector<std::string>& names) {
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
}

/// Verbs whose arguments are components, by their names from the first on.
bool names_components(const std::vector<std::string>& verbs) {
  static const std::vector<std::vector<std::string>> known{
      {"run"}, {"component", "info"}, {"param", "list"}, {"param", "dump"}};
  const bool is_gcs = !verbs.empty() && verbs.front() == "gcs";  // which has param, too
  const std::vector<std::string> rest(verbs.begin() + (is_gcs ? 1 : 0), verbs.end());
  return std::find(known.begin(), known.end(), rest) != known.end();
}

std::vector<std::string> component_names() {
  std::vector<std::string> names;
  for (const auto& entry : ComponentRegistry::instance().entries()) names.push_back(entry.name);
  return names;
}

}  // namespace

std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return {};
  const CLI::App* verb = &app;
  std::vector<std::string> verbs;
  bool value_comes = false;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (std::exchange(value_comes, false)) continue;
    if (!words[i].empty() && words[i][0] == '-') {
      value_comes = takes_value(*verb, words[i]);
    } else if (const CLI::App* next = find_verb(*verb, words[i])) {
      verb = next;
      verbs.push_back(next->get_name());
    }
  }
  const std::string& begun = words.back();
  std::vector<std::string> names;
  if (value_comes) {
    // Of "--into" the values are components; of all others a file, a number or a name.
    if (words[words.size() - 2] == "--into") names = component_names();
  } else if (!begun.empty() && begun[0] == '-') {
    add_options(*verb, names);
  } else {
    add_verbs(*verb, names);
    if (names_components(verbs)) names = component_names();
    if (verbs == std::vector<std::string>{"gcs", "mode"}) names = mode_words();
  }
  const auto differs = [&begun](const std::string& name) {
    return name.compare(0, begun.size(), begun) != 0;
  };
  names.erase(std::remove_if(names.begin(), names.end(), differs), names.end());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace swiftlet
