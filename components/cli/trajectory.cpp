// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "components/cli/trajectory_report.hpp"
#include "components/cli/verbs.hpp"
#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

struct TrajectoryOptions {
  std::string waypoints;
  std::string plot;
  std::string csv;
  bool json = false;
};

/// Refuses a file that could not be written, before any work.
void check_output(const std::string& option, const std::filesystem::path& file) {
  if (file.empty()) return;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder)) {
    throw ConfigError(fmt::format("{} {}: there is no folder {}; make it", option, file.string(),
                                  folder.string()));
  }
  if (std::filesystem::is_directory(file)) {
    throw ConfigError(
        fmt::format("{} {}: a folder is there; choose a file", option, file.string()));
  }
}

Result<Trajectory> plan(const TrajectoryFile& task) {
  MinimumSnapPlanner::Params params;
  params.limits = task.limits;
  params.timing = Timing::kLeastSnap;
  params.reserve = 0.0;
  const MinimumSnapPlanner planner(params);
  return task.duration_s ? planner.plan_for(Time{}, task.start, task.waypoints, *task.duration_s)
                         : planner.plan(Time{}, task.start, task.waypoints);
}

/// Plans and writes what was asked for. Returns the exit code.
int trajectory(const TrajectoryOptions& options) {
  if (!options.plot.empty() && std::filesystem::path(options.plot).extension() != ".png") {
    throw ConfigError(
        fmt::format("--plot {}: figures are PNG files; end it with .png", options.plot));
  }
  check_output("--plot", options.plot);
  check_output("--csv", options.csv);
  TrajectoryReport report;
  report.task = TrajectoryFile::load(options.waypoints);
  const auto planned = plan(report.task);
  if (!planned) {
    fmt::print(stderr, "swiftlet: {}: {}\n", options.waypoints, planned.error().reason);
    return 1;
  }
  report.trajectory = *planned;
  fmt::print("{}", options.json ? to_json(report) + "\n" : to_text(report));
  int exit_code = 0;
  const auto write = [&](const std::string& file, auto&& how) {
    if (file.empty()) return;
    if (const Status written = how(report, file); !written) {
      fmt::print(stderr, "swiftlet: {}\n", written.error().reason);
      exit_code = 1;
    }
  };
  write(options.csv, write_csv);
  write(options.plot, write_plot);
  return exit_code;
}

}  // namespace

void add_trajectory(CLI::App& app) {
  auto options = std::make_shared<TrajectoryOptions>();
  CLI::App* verb = app.add_subcommand(
      "trajectory", "Plan a minimum-snap trajectory through waypoints, within limits");
  verb->add_option("waypoints", options->waypoints,
                   "YAML file: start, waypoints, limits, duration_s")
      ->required();
  verb->add_option("--plot", options->plot, "Draw the way and what is limited into this PNG file");
  verb->add_option("--csv", options->csv, "Write samples at 100 Hz into this file");
  verb->add_flag("--json", options->json, "Print the result as JSON");
  verb->callback([options] {
    if (const int code = trajectory(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
