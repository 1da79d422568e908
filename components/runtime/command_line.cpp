// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/command_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "components/runtime/names.hpp"

namespace swiftlet {

void ParameterOptions::add_to(CLI::App& verb) {
  verb.add_option("--params", file_, "YAML file with a section for each component");
  verb.add_option("--param", values_, "One parameter: component.key=value; wins over the file")
      ->take_all();
}

Config ParameterOptions::load() const {
  Config config = file_.empty() ? Config() : Config::load(file_);
  std::vector<std::string> names = config.keys();
  for (const std::string& value : values_) {
    const std::size_t equals = value.find('=');
    const std::size_t dot = value.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
      throw ConfigError(
          fmt::format("--param {}: write it as component.key=value, for instance "
                      "planner.max_speed=1.5",
                      value));
    }
    config.set(value.substr(0, equals), value.substr(equals + 1));
    names.push_back(value.substr(0, dot));
  }
  // Sections of components that run elsewhere are fine, those of none are not.
  std::vector<std::string> known;
  for (const auto& entry : ComponentRegistry::instance().entries()) known.push_back(entry.name);
  for (const std::string& name : names) {
    if (ComponentRegistry::instance().find(name) != nullptr) continue;
    const std::string near = nearest_word(name, known);
    config.fail(name, fmt::format("there is no component '{}'; {}", name,
                                  near.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                                               : fmt::format("did you mean '{}'?", near)));
  }
  return config;
}

void ParameterOptions::finish(const Config& parameters, const std::vector<std::string>& hosted) {
  for (const std::string& section : parameters.keys()) {
    const bool is_hosted = std::find(hosted.begin(), hosted.end(), section) != hosted.end();
    if (!is_hosted) (void)parameters.has(section);  // asked for, so known
  }
  parameters.finish();
}

void NetworkOptions::add_to(CLI::App& verb) {
  verb.add_option("--domain", domain_, "DDS domain; else ROS_DOMAIN_ID, else 0")
      ->check(CLI::Range(0, 232));
  verb.add_option("--vehicle", vehicle_, "Prefix of all topics, for several vehicles");
  verb.add_option("--network", interfaces_,
                  "Addresses of the interfaces to use; else only this machine is reached");
}

HostOptions NetworkOptions::host_options(const std::string& name) const {
  HostOptions options;
  if (!vehicle_.empty()) {
    const Status status = check_name(vehicle_);
    if (!status.ok()) throw ConfigError("--vehicle: " + status.error().reason);
  }
  options.vehicle = vehicle_;
  options.participant.name = fmt::format("{}.{}", name, getpid());
  options.participant.domain = domain_ >= 0 ? domain_ : domain_from_environment();
  if (!interfaces_.empty()) options.participant.interfaces = interfaces_;
  return options;
}

}  // namespace swiftlet
