// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command/ground_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

namespace swiftlet {
namespace {

/// As it travels with every command.
constexpr std::size_t kLongestName = 40;

std::string check_name(const std::string& name) {
  if (!name.empty() && name.size() <= kLongestName) return "";
  return fmt::format("a station's name has 1 to {} characters", kLongestName);
}

}  // namespace

void GroundOptions::add_to(CLI::App& verb) {
  NetworkOptions::add_to(verb);
  verb.add_option("--station", station_,
                  "Name of this ground station; one at a time has control of a vehicle. Stations "
                  "of the same name are one")
      ->envname("SWIFTLET_STATION")
      ->check(check_name)
      ->capture_default_str();
}

std::string GroundOptions::host_name() {
  char name[kLongestName + 1] = "";
  // A name that is cut is one, too.
  (void)gethostname(name, kLongestName);
  return *name == '\0' ? "ground" : name;
}

}  // namespace swiftlet
