// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/command_line.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
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

Config ParameterOptions::load(const std::string& recorded) const {
  Config config =
      file_.empty() ? Config::parse(recorded, "recorded parameters") : Config::load(file_);
  const auto check_component = [&config](const std::string& name, const std::string& value) {
    if (ComponentRegistry::instance().find(name) != nullptr) return;
    std::vector<std::string> known;
    for (const auto& entry : ComponentRegistry::instance().entries()) known.push_back(entry.name);
    const std::string near = nearest_word(name, known);
    const std::string problem =
        fmt::format("there is no component '{}'; {}", name,
                    near.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                                 : fmt::format("did you mean '{}'?", near));
    if (value.empty()) config.fail(name, problem);
    throw ConfigError(fmt::format("--param {}: {}", value, problem));
  };
  // Sections of components that run elsewhere are fine, those of none are not.
  for (const std::string& name : config.keys()) check_component(name, "");
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
    check_component(value.substr(0, dot), value);
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

namespace {

/// IPv4 addresses of this host.
std::vector<std::string> local_addresses() {
  std::vector<std::string> addresses;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return addresses;
  for (const ifaddrs* entry = all; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    char text[INET_ADDRSTRLEN];
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof(text)) != nullptr) {
      addresses.emplace_back(text);
    }
  }
  freeifaddrs(all);
  return addresses;
}

}  // namespace

HostOptions NetworkOptions::host_options(const std::string& name) const {
  HostOptions options;
  if (!vehicle_.empty()) {
    const Status status = check_name(vehicle_);
    if (!status.ok()) throw ConfigError("--vehicle: " + status.error().reason);
  }
  options.vehicle = vehicle_;
  options.participant.name = fmt::format("{}.{}", name, getpid());
  options.participant.domain = domain_ >= 0 ? domain_ : domain_from_environment();
  for (const std::string& wanted : interfaces_) {
    const std::vector<std::string> addresses = local_addresses();
    if (std::find(addresses.begin(), addresses.end(), wanted) == addresses.end()) {
      throw ConfigError(
          fmt::format("--network {}: no interface of this host has that address; "
                      "they have {}",
                      wanted, fmt::join(addresses, ", ")));
    }
  }
  if (!interfaces_.empty()) options.participant.interfaces = interfaces_;
  return options;
}

}  // namespace swiftlet
