// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/command_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "components/runtime/dds/qos_overrides.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/number_check.hpp"
#include "components/topics.hpp"

namespace swiftlet {

void ParameterOptions::add_to(CLI::App& verb) {
  verb.add_option("--params", file_, "YAML file with a section for each component");
  verb.add_option("--param", values_, "One parameter: component.key=value; wins over the file")
      ->take_all();
}

Config ParameterOptions::load(const std::string& recorded) const {
  Config config =
      file_.empty() ? Config::parse(recorded, "recorded parameters") : Config::load(file_);
  if (config.has("hosts")) {
    // A system file: the rest of it is for `swiftlet launch`.
    for (const std::string& key : config.keys()) (void)config.has(key);
    config = config.child("parameters");
  }
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
      ->check(whole_within(0, 232));
  verb.add_option("--vehicle", vehicle_, "Prefix of all topics, for several vehicles");
  const char* group = "Network";
  const auto add_list = [&](const char* name, std::vector<std::string>& list, const char* what) {
    // One value each time, so that what follows is not taken for another.
    verb.add_option(name, list, what)->expected(1)->take_all()->delimiter(',')->group(group);
  };
  add_list("--network", network_.interfaces,
           "Name or address of an interface to use, several by repeating it; else only this "
           "machine is reached");
  add_list("--peer", network_.peers, "ADDRESS[:PORT] of a host to find by unicast");
  add_list("--discovery-server", network_.discovery_servers,
           "ADDRESS:PORT of a Fast DDS discovery server; the first has --server-id 0");
  verb.add_option("--multicast", network_.multicast,
                  "true or false: announce by multicast; else where there is no peer or server")
      ->group(group);
  verb.add_option("--multicast-ttl", network_.multicast_ttl, "Hops that announcements may take")
      ->check(whole_within(0, 255))
      ->group(group);
  verb.add_option("--network-wait", network_.wait, "Wait so long for the interfaces [s]")
      ->check(within(0.0, 3600.0))
      ->group(group);
  verb.add_option("--max-datagram", network_.max_datagram, "Largest UDP datagram [byte]")
      ->check(whole_within(576, 65500))
      ->group(group);
  verb.add_option("--see-all", network_.see_all,
                  "true or false: hear of all topics through a discovery server, or of one's own")
      ->group(group);
  verb.add_option("--pace", network_.pace, "Limit for samples above 64 kB [byte/s]")
      ->check(whole_within(0, 1'000'000'000))
      ->group(group);
  verb.add_option("--qos-profiles", qos_file_,
                  "Fast DDS profiles file (XML); its data_writer and data_reader profiles that are "
                  "named as ours (sensor, state, command, map, event, bulk) or as a topic override "
                  "the policies that stand in them");
}

HostOptions NetworkOptions::host_options(const std::string& name) const {
  HostOptions options;
  if (!vehicle_.empty()) {
    const Status status = check_name(vehicle_);
    if (!status.ok()) throw ConfigError("--vehicle: " + status.error().reason);
  }
  options.vehicle = vehicle_;
  if (!qos_file_.empty()) {
    QosOverrides::Names names;
    names.topics.assign(std::begin(topic::names), std::end(topic::names));
    names.vehicle = vehicle_;
    options.participant.qos_overrides =
        std::make_shared<const QosOverrides>(QosOverrides::load(qos_file_, names));
  }
  options.participant.name = fmt::format("{}.{}", name, getpid());
  options.participant.domain = domain_ >= 0 ? domain_ : domain_from_environment();
  wait_for_interfaces(network_);
  options.participant.network = network_;
  return options;
}

}  // namespace swiftlet
