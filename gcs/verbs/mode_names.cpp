// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mode_names.hpp"

#include <fmt/format.h>

#include <cctype>
#include <optional>
#include <vector>

#include "components/command_name.hpp"
#include "components/runtime/config/nearest_word.hpp"
#include "control/mode_machine.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {
namespace {

namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

/// A mode that can be asked for. Grounded is what a landing ends in.
struct Entry {
  Mode mode;
  std::vector<const char*> others;     // names, as plain() makes them
  std::optional<std::uint8_t> code{};  // none: it needs a place
  const char* verb = "";               // that takes the place
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> entries{
      {Mode::kTakeoff, {}, command::TAKEOFF},
      {Mode::kHover, {}, command::HOVER},
      {Mode::kLand, {"landing"}, command::LAND},
      {Mode::kManual, {}, command::MANUAL},
      {Mode::kAssistedManual, {"assist", "assisted"}, command::ASSIST},
      {Mode::kGpsGuidance, {"gps"}, std::nullopt, "gps LATITUDE LONGITUDE"},
      {Mode::kIndoorNavigation, {"navigation", "goto"}, std::nullopt, "goto X Y [Z]"},
      {Mode::kIndoorExploration, {"explore", "exploration"}, command::EXPLORE}};
  return entries;
}

/// Letters and digits alone, small.
std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) text += static_cast<char>(std::tolower(letter));
  }
  return text;
}

bool is_called(const Entry& entry, const std::string& name) {
  if (plain(to_string(entry.mode)) == name) return true;
  for (const char* other : entry.others) {
    if (name == other) return true;
  }
  return false;
}

}  // namespace

Result<std::uint8_t> command_of_mode(const std::string& name) {
  const std::string wanted = plain(name);
  if (wanted == "return") return static_cast<std::uint8_t>(command::RETURN);
  std::vector<std::string> names;
  for (const Entry& entry : entries()) {
    names.emplace_back(to_string(entry.mode));
    if (!is_called(entry, wanted)) continue;
    if (entry.code) return *entry.code;
    return Error{fmt::format("{} needs to know where to: swiftlet gcs {}", to_string(entry.mode),
                             entry.verb)};
  }
  const std::string near = nearest_word(name, names);
  return Error{fmt::format("there is no mode '{}'; {}there are {}, and return", name,
                           near.empty() ? "" : fmt::format("did you mean '{}'? ", near),
                           fmt::join(names, ", "))};
}

std::vector<std::string> mode_words() {
  std::vector<std::string> words{"return"};
  for (const Entry& entry : entries()) {
    if (entry.code) words.push_back(command_name(*entry.code));
  }
  return words;
}

}  // namespace swiftlet
