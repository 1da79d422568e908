// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/experiment_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "components/experiments/experiment.hpp"
#include "components/runtime/config/config.hpp"
#include "components/runtime/number_check.hpp"

namespace swiftlet {
namespace {

struct Options {
  ExperimentOptions experiment;
  bool json = false;
};

void show_progress(int done, int total) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{} of {}{}", done, total, done == total ? "\n" : "");
  std::fflush(stderr);
}

int run(const Experiment& experiment, Options options) {
  if (experiment.reads_data && options.experiment.data.empty()) {
    throw ConfigError(fmt::format("experiment {}: needs --data DIR; {}", experiment.name,
                                  "see components/experiments/README.md for what it reads"));
  }
  if (!options.experiment.report.empty()) {
    std::error_code error;
    std::filesystem::create_directories(options.experiment.report, error);
    if (!std::filesystem::is_directory(options.experiment.report)) {
      throw ConfigError(fmt::format("--report {}: cannot be made ({}); choose another folder",
                                    options.experiment.report.string(), error.message()));
    }
  }
  options.experiment.progress = show_progress;
  const Result<ExperimentResult> result = experiment.run(options.experiment);
  if (!result) {
    fmt::print(stderr, "swiftlet: experiment {}: {}\n", experiment.name, result.error().reason);
    return 1;
  }
  fmt::print("{}", options.json ? to_json(*result) : to_table(*result));
  if (!options.json && !options.experiment.report.empty()) {
    fmt::print("figures    {}\n", options.experiment.report.string());
  }
  return result->holds() ? 0 : 1;
}

void list(bool json) {
  auto all = nlohmann::json::array();
  for (const Experiment& experiment : experiments()) {
    if (json) {
      all.push_back({{"name", experiment.name},
                     {"summary", experiment.summary},
                     {"reads_data", experiment.reads_data}});
    } else {
      fmt::print("{:24} {}{}\n", experiment.name, experiment.summary,
                 experiment.reads_data ? " (--data DIR)" : "");
    }
  }
  if (json) fmt::print("{}\n", all.dump(2));
}

}  // namespace

void add_experiment(CLI::App& app) {
  CLI::App* group =
      app.add_subcommand("experiment", "Run a paper's experiment again, its table beside ours");
  group->require_subcommand(1);
  auto as_json = std::make_shared<bool>(false);
  CLI::App* list_verb = group->add_subcommand("list", "The experiments that there are");
  list_verb->add_flag("--json", *as_json, "For programs");
  list_verb->callback([as_json] { list(*as_json); });
  for (const Experiment& experiment : experiments()) {
    auto options = std::make_shared<Options>();
    CLI::App* verb = group->add_subcommand(experiment.name, experiment.summary);
    verb->add_option("--seeds", options->experiment.seeds, "How many runs, each with its own seed")
        ->check(whole_within(1, 10000))
        ->capture_default_str();
    verb->add_option("--report", options->experiment.report,
                     "Folder for figures; made where it is missing");
    verb->add_option("--data", options->experiment.data, "Folder with the data that it reads")
        ->check(CLI::ExistingDirectory);
    verb->add_flag("--json", options->json, "For programs");
    verb->callback([options, &experiment] {
      if (const int code = run(experiment, *options); code != 0) throw CLI::RuntimeError(code);
    });
  }
}

}  // namespace swiftlet
