// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <set>

#include "components/cli/verbs.hpp"
#include "components/launch/system_file.hpp"
#include "components/runtime/command_line.hpp"
#include "components/runtime/execution/real_time.hpp"
#include "components/runtime/number_check.hpp"

namespace swiftlet {
namespace {

struct RunOptions {
  std::vector<std::string> components;
  std::string scenario;
  int standby = 0;
  int real_time_priority = 0;  // 0: not asked for
  ParameterOptions parameters;
  NetworkOptions network;
};

/// Says what was granted; where it was refused the components run nevertheless.
void enter_real_time(int priority) {
  const RealTimeGrant grant = ask_for_real_time(priority);
  if (grant.scheduling.ok()) {
    logger("run")->info("real time: SCHED_FIFO, priority {}", priority);
  } else {
    logger("run")->warn("real time: {}", grant.scheduling.error().reason);
  }
  if (grant.memory.ok()) {
    logger("run")->info("real time: memory is locked");
  } else {
    logger("run")->warn("real time: {}", grant.memory.error().reason);
  }
}

int run(const RunOptions& options) {
  std::set<std::string> named;
  for (const std::string& name : options.components) {
    if (!named.insert(name).second) {
      throw ConfigError(
          fmt::format("'{}' is named twice; one process hosts each component at most once", name));
    }
  }
  Config parameters = options.parameters.load();
  if (options.real_time_priority > 0) enter_real_time(options.real_time_priority);
  HostOptions host_options =
      options.network.host_options(fmt::format("{}", fmt::join(options.components, "+")));
  host_options.standby = options.standby;
  Host host(host_options);
  for (const std::string& name : options.components) {
    // One scenario for all who need one.
    if (reads_scenario(name) && !options.scenario.empty()) {
      parameters.set(name + ".scenario", options.scenario);
    } else if (reads_scenario(name) && !parameters.child(name).has("scenario")) {
      throw ConfigError(fmt::format("'{}' needs a scenario; add --scenario FILE", name));
    }
    host.add(name, parameters.child(name));
  }
  ParameterOptions::finish(parameters, options.components);
  for (const std::string& name : options.components) logger("run")->info("hosting {}", name);
  return host.run();
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb = app.add_subcommand("run", "Host components on this machine");
  verb->add_option("components", options->components, "See: swiftlet component list --available")
      ->required();
  verb->add_option("--scenario", options->scenario,
                   "Scenario file of the simulators and the pilot");
  verb->add_option(
          "--standby", options->standby,
          "Place in the line of succession: 0 comes first; 1 and above wait, hear everything "
          "and take over when the active instance falls silent")
      ->check(whole_within(0, 9));
  verb->add_option("--rt", options->real_time_priority,
                   "Ask for real time: SCHED_FIFO with this priority, and locked memory; the log "
                   "says what was granted")
      ->check(whole_within(1, 99));
  options->parameters.add_to(*verb);
  options->network.add_to(*verb);
  verb->callback([options] {
    if (const int code = run(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
