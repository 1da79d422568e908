// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/command/ground_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

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
  verb.add_option(
          "--station", station_,
          "Name of this ground station, else that of SWIFTLET_STATION, else the host's; one "
          "at a time has control of a vehicle")
      ->check(check_name)
      ->capture_default_str();
}

GroundStation GroundOptions::enter() const {
  GroundStation station{station_, host_options("gcs")};
  station.host.shared = std::make_shared<Participant>(station.host.participant);
  return station;
}

// Not CLI11's: all verbs have the option, and each that is not used would bring the variable back.
std::string GroundOptions::own_name() {
  const char* told = std::getenv("SWIFTLET_STATION");
  if (told != nullptr && *told != '\0') return std::string(told).substr(0, kLongestName);
  char name[kLongestName + 1] = "";
  // A name that is cut is one, too.
  (void)gethostname(name, kLongestName);
  return *name == '\0' ? "ground" : name;
}

}  // namespace swiftlet
