// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/launch/system_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <set>

#include "components/runtime/component.hpp"
#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

/// Longer than the lease of a discovery server, 20 s: clients that did not miss it would take the
/// one that is back for the old one, and pass over what it says (discovery-server.xml).
constexpr double kServerPause = 21.0;

constexpr int kLastDomain = 232;

/// ", did you mean 'x'?" or "; there are x, y".
std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? fmt::format("; there are {}", fmt::join(known, ", "))
                      : fmt::format("; did you mean '{}'?", near);
}

void check_component(const Config& section, const std::string& key, const std::string& name) {
  if (ComponentRegistry::instance().find(name) != nullptr) return;
  std::vector<std::string> known;
  for (const auto& entry : ComponentRegistry::instance().entries()) known.push_back(entry.name);
  section.fail(key, fmt::format("there is no component '{}'{}", name, suggestion(name, known)));
}

std::optional<int> read_domain(const Config& section) {
  if (!section.has("domain")) return std::nullopt;
  int domain = 0;
  section.read("domain", domain, {0, kLastDomain});
  return domain;
}

RestartPolicy read_restart(const Config& section) {
  RestartPolicy policy;
  section.read("max_restarts", policy.max_restarts, {0, 1000});
  section.read("window", policy.window, kPositive);
  section.read("backoff", policy.backoff, kNotNegative);
  section.read("max_backoff", policy.max_backoff, kNotNegative);
  return policy;
}

DiscoveryServerSpec read_server(const Config& section) {
  DiscoveryServerSpec server;
  section.read("id", server.id, {0, 255});
  section.read("address", server.address);
  section.read("port", server.port, {1, 65535});
  return server;
}

ProcessSpec read_process(const Config& section) {
  ProcessSpec process;
  section.read("components", process.components);
  section.read("verb", process.verb);
  section.read("arguments", process.arguments);
  section.read("standby", process.standby, {0, 9});
  if (process.components.empty() == process.verb.empty()) {
    section.fail({}, "a process has either 'components' or a 'verb', such as [bag, record]");
  }
  std::set<std::string> once;
  for (const std::string& component : process.components) {
    check_component(section, "components", component);
    if (!once.insert(component).second) {
      section.fail("components", fmt::format("'{}' is named twice in one process", component));
    }
  }
  if (process.standby > 0 && process.components.empty()) {
    section.fail("standby", "only components can stand by");
  }
  process.name = fmt::format(
      "{}", fmt::join(process.components.empty() ? process.verb : process.components, "+"));
  if (!process.verb.empty()) process.name = fmt::format("{}", fmt::join(process.verb, "_"));
  if (process.standby > 0) process.name += fmt::format("@{}", process.standby);
  section.read("name", process.name);
  return process;
}

HostSpec read_host(const Config& section, const NetworkConfig& network) {
  HostSpec host;
  host.domain = read_domain(section);
  host.network = read_network(section.child("network"), network);
  if (section.has("discovery_server")) {
    host.discovery_server = read_server(section.child("discovery_server"));
  }
  for (const Config& process : section.list("processes")) {
    host.processes.push_back(read_process(process));
  }
  // The short form: each in a process of its own, so that a crash takes down only itself.
  std::vector<std::string> components;
  section.read("components", components);
  for (const std::string& component : components) {
    check_component(section, "components", component);
    ProcessSpec process;
    process.name = component;
    process.components = {component};
    host.processes.push_back(process);
  }
  std::set<std::string> names;
  std::set<std::pair<std::string, int>> instances;
  for (const ProcessSpec& process : host.processes) {
    if (!names.insert(process.name).second) {
      section.fail({}, fmt::format("two processes are called '{}'; give one of them another 'name'",
                                   process.name));
    }
    for (const std::string& component : process.components) {
      if (!instances.insert({component, process.standby}).second) {
        section.fail(
            {}, fmt::format("'{}' runs twice; a second one has a 'standby' of its own", component));
      }
    }
  }
  return host;
}

bool needs_scenario(const ProcessSpec& process) {
  return std::any_of(process.components.begin(), process.components.end(), reads_scenario);
}

std::string this_machine() {
  char name[HOST_NAME_MAX + 1] = "";
  gethostname(name, HOST_NAME_MAX);
  return name;
}

}  // namespace

bool reads_scenario(const std::string& component) {
  return component == "sim" || component == "sim_claw" || component == "pilot";
}

SystemFile SystemFile::load(const std::filesystem::path& file) {
  const Config config = Config::load(file);
  SystemFile system;
  system.file = file;
  system.domain = read_domain(config);
  config.read("vehicle", system.vehicle);
  if (!system.vehicle.empty()) {
    const Status status = check_name(system.vehicle);
    if (!status.ok()) config.fail("vehicle", "'vehicle': " + status.error().reason);
  }
  std::string scenario;
  config.read("scenario", scenario);
  if (!scenario.empty()) {
    system.scenario = config.folder() / scenario;
    std::error_code ignored;  // such as a name that is too long
    if (!std::filesystem::is_regular_file(system.scenario, ignored)) {
      config.fail("scenario", fmt::format("there is no file {}", system.scenario.string()));
    }
  }
  // Each component reads its own section; here only their names are checked.
  system.has_parameters = config.has("parameters");
  const Config parameters = config.child("parameters");
  for (const std::string& name : parameters.keys()) {
    check_component(parameters, name, name);
    (void)parameters.has(name);
  }
  std::string on_failure = "stop";
  config.read("on_failure", on_failure);
  if (on_failure != "stop" && on_failure != "continue") {
    config.fail("on_failure",
                fmt::format("'on_failure' is stop or continue, not '{}'", on_failure));
  }
  system.stop_on_failure = on_failure == "stop";
  config.read("stop_timeout", system.stop_timeout, kPositive);
  system.restart = read_restart(config.child("restart"));
  const NetworkConfig network = read_network(config.child("network"));

  config.demand("hosts");
  const Config hosts = config.child("hosts");
  for (const std::string& name : hosts.keys()) {
    const HostSpec host = read_host(hosts.child(name), network);
    for (const ProcessSpec& process : host.processes) {
      if (needs_scenario(process) && system.scenario.empty()) {
        config.fail({}, fmt::format("'{}' on '{}' needs a scenario; add 'scenario: FILE'",
                                    process.name, name));
      }
    }
    system.hosts[name] = host;
  }
  config.finish();
  if (system.hosts.empty()) config.fail("hosts", "'hosts' has no host; add one");
  return system;
}

const HostSpec& SystemFile::host(const std::string& name) const {
  std::vector<std::string> known;
  for (const auto& [other, host] : hosts) known.push_back(other);
  if (name.empty() && hosts.size() == 1) return hosts.begin()->second;
  const std::string wanted = name.empty() ? this_machine() : name;
  const auto found = hosts.find(wanted);
  if (found != hosts.end()) return found->second;
  if (name.empty()) {
    throw ConfigError(fmt::format(
        "{}: this machine, '{}', is none of its hosts; say which one it is with --host: {}",
        file.string(), wanted, fmt::join(known, ", ")));
  }
  throw ConfigError(fmt::format("--host {}: {} has no such host{}", name, file.string(),
                                suggestion(name, known)));
}

std::vector<CommandLine> command_lines(const SystemFile& system, const HostSpec& host,
                                       const std::string& program) {
  std::vector<CommandLine> lines;
  if (host.discovery_server) {
    const DiscoveryServerSpec& server = *host.discovery_server;
    // What `fastdds discovery` runs, without the script in between that would not pass on signals.
    lines.push_back({"discovery_server",
                     {"fast-discovery-server", "-i", std::to_string(server.id), "-l",
                      server.address, "-p", std::to_string(server.port)},
                     kServerPause});
  }
  for (const ProcessSpec& process : host.processes) {
    std::vector<std::string> words{program};
    const auto add = [&words](const std::vector<std::string>& more) {
      words.insert(words.end(), more.begin(), more.end());
    };
    const auto level = spdlog::level::to_string_view(spdlog::get_level());
    if (spdlog::get_level() != spdlog::level::info) add({"--log", {level.data(), level.size()}});
    if (process.verb.empty()) {
      add({"run"});
      add(process.components);
      if (process.standby > 0) add({"--standby", std::to_string(process.standby)});
      if (needs_scenario(process)) add({"--scenario", system.scenario.string()});
      if (system.has_parameters) add({"--params", system.file.string()});
    } else {
      add(process.verb);
    }
    const std::optional<int> domain = host.domain ? host.domain : system.domain;
    if (domain) add({"--domain", std::to_string(*domain)});
    if (!system.vehicle.empty()) add({"--vehicle", system.vehicle});
    add(to_arguments(host.network));
    add(process.arguments);
    lines.push_back({process.name, words});
  }
  return lines;
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$`*?[]{}()<>|&;#~!") == std::string::npos;
    std::string safe;
    for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += fmt::format("{}{}", text.empty() ? "" : " ", plain ? word : "'" + safe + "'");
  }
  return text;
}

}  // namespace swiftlet
