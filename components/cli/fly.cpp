// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <limits>
#include <optional>

#include "components/bag/content_hash.hpp"
#include "components/bag/recorder.hpp"
#include "components/bag/recording_records.hpp"
#include "components/cli/flight_report.hpp"
#include "components/cli/progress.hpp"
#include "components/cli/verbs.hpp"
#include "components/lidar_mapper/map_keeper.hpp"
#include "components/runtime/command_line.hpp"
#include "components/runtime/number_check.hpp"
#include "components/sim/pilot.hpp"
#include "components/sim/referee.hpp"

namespace swiftlet {
namespace {

struct FlyOptions {
  std::string scenario;
  bool real_time = false;
  std::string record;
  std::string report;
  std::optional<int> seed;
  std::vector<std::string> what_if;
  ParameterOptions parameters;
  NetworkOptions network;
};

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) {
    throw ConfigError(fmt::format("--report {}: cannot be made ({}); choose another folder",
                                  folder.string(), error.message()));
  }
}

/// Simulates and flies a scenario, all in one process. Returns the exit code.
int fly(const FlyOptions& options) {
  Scenario scenario = Scenario::load(options.scenario);
  if (options.seed) scenario.seed = static_cast<std::uint64_t>(*options.seed);
  Config parameters = options.parameters.load();
  parameters.set("sim.scenario", options.scenario);
  if (scenario.claw) parameters.set("sim_claw.scenario", options.scenario);
  parameters.set("sim.seed", std::to_string(scenario.seed));
  if (!parameters.child("planner").has("seed")) {
    parameters.set("planner.seed", std::to_string(scenario.seed));
  }

  HostOptions host_options = options.network.host_options("fly");
  host_options.lockstep = !options.real_time;
  for (const std::string& fault : options.what_if) {
    host_options.faults.push_back(parse_fault(fault));
  }
  host_options.fault_seed = scenario.seed;
  Host host(host_options);
  const std::vector<std::string> names = components_of(scenario);
  for (const std::string& name : names) host.add(name, parameters.child(name));
  auto& pilot = host.emplace<Pilot>("pilot", scenario);
  auto& referee = host.emplace<Referee>("referee");
  auto& map = host.emplace<MapKeeper>("map_keeper");
  host.emplace<Progress>("progress");
  ParameterOptions::finish(parameters, names);
  // Nothing is written before everything is known to be usable.
  if (!options.report.empty() && std::filesystem::exists(options.report) &&
      !std::filesystem::is_directory(options.report)) {
    throw ConfigError(fmt::format("--report {}: a file is there; choose a folder", options.report));
  }
  Recorder* recorder = nullptr;
  if (!options.record.empty()) {
    RecorderParams params;
    params.file = options.record;
    params.overwrite = true;
    params.run = {{kRunComponentsKey, fmt::format("{}", fmt::join(names, " "))},
                  {kRunParametersKey, parameters.dump()}};
    recorder = &host.emplace<Recorder>("recorder", params);
  }
  if (!options.report.empty()) make_folder(options.report);

  const auto wall_begin = std::chrono::steady_clock::now();
  const Time begin = host.executor().now();
  int exit_code = host.run();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_begin;

  FlightReport report;
  report.scenario = scenario;
  report.outcome = pilot.outcome();
  if (!report.outcome.finished) {
    report.outcome.reason = exit_code == 0 ? "interrupted" : "ended by the error above";
  }
  report.record = referee.record();
  report.map = map.latest();
  report.speed_factor = to_seconds(host.executor().now() - begin) / wall.count();
  if (recorder != nullptr) {
    const Status closed = recorder->close();
    const auto hash = closed.ok() ? content_hash(options.record) : closed.error();
    if (!hash.ok()) {
      fmt::print(stderr, "swiftlet: {}\n", hash.error().reason);
      exit_code = 1;
    } else {
      report.bag_hash = *hash;
    }
  }
  if (!options.report.empty()) {
    const Status written = write(report, options.report);
    if (!written.ok()) {
      fmt::print(stderr, "swiftlet: {}\n", written.error().reason);
      exit_code = 1;
    }
  }
  fmt::print("{}", summary(report));
  if (!options.report.empty()) fmt::print("report     {}\n", options.report);
  return exit_code == 0 && success(report) ? 0 : 1;
}

}  // namespace

void add_fly(CLI::App& app) {
  auto options = std::make_shared<FlyOptions>();
  CLI::App* verb = app.add_subcommand("fly", "Simulate and fly a scenario, all in one process");
  verb->add_option("scenario", options->scenario, "Scenario file")->required();
  verb->add_flag("--real-time", options->real_time,
                 "As fast as time passes, visible to other processes; else in lockstep");
  verb->add_option("--record", options->record, "Record all topics into this MCAP file");
  verb->add_option("--report", options->report,
                   "Folder for report.json, flight.png and the map; made where it is missing");
  verb->add_option("--seed", options->seed, "Seed of everything random, instead of the scenario's")
      ->check(whole_within(0, std::numeric_limits<int>::max()));
  verb->add_option("--what-if", options->what_if,
                   "Something that goes wrong: \"kill estimator@12.5\", \"delay scan 80ms\", "
                   "\"drop imu0 20%\", the last two with \"@3..4.5\" for a time; may be repeated")
      ->take_all();
  options->parameters.add_to(*verb);
  options->network.add_to(*verb);
  verb->callback([options] {
    if (const int code = fly(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
