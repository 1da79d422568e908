// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/replay/replay_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "components/bag/bag_info.hpp"
#include "components/bag/recording_records.hpp"
#include "components/lidar_mapper/map_keeper.hpp"
#include "components/replay/replay_components.hpp"
#include "components/runtime/command_line.hpp"
#include "components/runtime/names.hpp"
#include "perception/map_io.hpp"

namespace swiftlet {
namespace {

constexpr const char* kSource = "replay";

struct ReplayOptions {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> into;
  std::vector<std::string> what_if;
  std::string map;
  bool compare = false;
  bool json = false;
  ParameterOptions parameters;
};

/// What a recording says of the run that it is of.
struct RecordedRun {
  std::optional<Time> start;
  std::vector<std::string> components;  ///< in the order in which they were made
  std::string parameters;               ///< YAML
};

RecordedRun run_of(const Recording& recording) {
  RecordedRun run;
  const auto record = metadata_named(recording, kRunRecord);
  if (!record) return run;
  const auto value = [&record](const char* key) {
    const auto found = record->metadata.find(key);
    return found == record->metadata.end() ? std::string() : found->second;
  };
  const std::string start = value(kRunStartKey);
  if (!start.empty() && start.find_first_not_of("0123456789") == std::string::npos) {
    run.start = mcap::to_time(std::strtoull(start.c_str(), nullptr, 10));
  }
  std::istringstream names(value(kRunComponentsKey));
  for (std::string name; names >> name;) run.components.push_back(name);
  run.parameters = value(kRunParametersKey);
  return run;
}

/// In the order of the recorded run: who is first at a moment belongs to what is repeated.
std::vector<std::string> components_to_run(const ReplayOptions& options, const RecordedRun& run,
                                           const std::string& file) {
  if (options.into.empty() && run.components.empty()) {
    throw ConfigError(fmt::format(
        "{}: does not say which components it is of; name those to run with --into", file));
  }
  std::vector<std::string> names = options.into;
  if (names.empty()) {
    // The simulator is the world: what it published is what is replayed.
    std::copy_if(run.components.begin(), run.components.end(), std::back_inserter(names),
                 [](const std::string& name) { return name != "sim"; });
  }
  const auto place = [&run](const std::string& name) {
    return std::find(run.components.begin(), run.components.end(), name) - run.components.begin();
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return place(a) < place(b); });
  return names;
}

/// Refuses a place where a map cannot be saved, before the work is done.
void check_map_file(const std::filesystem::path& file) {
  if (file.extension() != ".pgm" && file.extension() != ".png") {
    throw ConfigError(fmt::format(
        "--map {}: a map is saved as .pgm or .png; end it with one of them", file.string()));
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder)) {
    throw ConfigError(
        fmt::format("--map {}: there is no folder {}; make it", file.string(), folder.string()));
  }
}

/// Topics that the components write, with their types on the wire. They are made once for that.
std::map<std::string, std::string> outputs_of(const std::vector<std::string>& components,
                                              const Config& parameters) {
  HostOptions options;
  options.lockstep = true;
  Host host(options);
  for (const std::string& name : components) host.add(name, parameters.child(name));
  std::map<std::string, std::string> outputs;
  for (const Endpoint& endpoint : host.participant()->graph().endpoints()) {
    if (endpoint.is_writer) outputs[topic_of("", endpoint.topic)] = endpoint.type;
  }
  return outputs;
}

std::string describe(const ReplayDifference& difference) {
  std::string text = fmt::format("{} at {:.9f} s: ", difference.topic, to_seconds(difference.time));
  if (!difference.field.empty()) text += difference.field + " ";
  return text + fmt::format("recorded {}, replayed {}", difference.recorded, difference.replayed);
}

nlohmann::json to_json(const ReplayResult& result, std::uint64_t inputs) {
  nlohmann::json json{{"inputs", inputs},
                      {"compared", result.compared},
                      {"different", result.different},
                      {"different_by_topic", result.different_by_topic},
                      {"hash", result.hash},
                      {"first", nullptr}};
  if (result.first) {
    json["first"] = {{"time_s", to_seconds(result.first->time)},
                     {"topic", result.first->topic},
                     {"field", result.first->field},
                     {"recorded", result.first->recorded},
                     {"replayed", result.first->replayed}};
  }
  return json;
}

void print(const ReplayResult& result, bool compare, std::uint64_t inputs, std::size_t topics) {
  fmt::print("replayed   {} messages of {} topics\n", inputs, topics);
  fmt::print("outputs    hash {}\n", result.hash);
  if (!compare) return;
  if (result.different == 0) {
    fmt::print("compared   {} outputs: identical\n", result.compared);
    return;
  }
  fmt::print("compared   {} outputs: {} are not as recorded\n", result.compared, result.different);
  fmt::print("first      {}\n", describe(*result.first));
  for (const auto& [topic, count] : result.different_by_topic) {
    fmt::print("           {:8} of {}\n", count, topic);
  }
}

int save(const ReplayOptions& options, const MapKeeper& keeper) {
  const auto grid = keeper.latest();
  if (!grid) {
    fmt::print(stderr,
               "swiftlet: {}: there was no map to save: replay into lidar_mapper, from a recording "
               "with scan and odometry\n",
               options.map);
    return 1;
  }
  const Status saved = save_map(*grid, options.map);
  if (!saved.ok()) {
    fmt::print(stderr, "swiftlet: {}\n", saved.error().reason);
    return 1;
  }
  if (!options.json) {
    fmt::print("map        {} ({} x {} cells of {} m)\n", options.map, grid->width(),
               grid->height(), grid->resolution());
  }
  return 0;
}

/// Runs components in lockstep on recorded inputs.
int replay(const ReplayOptions& options) {
  const auto opened = Recording::open(options.files);
  if (!opened.ok()) throw ConfigError(opened.error().reason);
  const Recording& recording = *opened;
  if (!options.map.empty()) check_map_file(options.map);
  // A recording that was cut off is replayed as far as it goes.
  for (const Error& error : recording.damage()) {
    fmt::print(stderr, "warning: {}\n", printable(error.reason));
  }
  const RecordedRun run = run_of(recording);
  const std::vector<std::string> components = components_to_run(options, run, recording.name());
  const Config parameters = options.parameters.load(run.parameters);
  const auto outputs = outputs_of(components, parameters);
  ParameterOptions::finish(parameters, components);
  std::set<std::string> output_topics;
  for (const auto& [topic, type] : outputs) output_topics.insert(topic);

  HostOptions host_options;
  host_options.lockstep = true;
  host_options.start = run.start.value_or(mcap::to_time(recording.statistics().message_start_time));
  for (const std::string& fault : options.what_if) {
    host_options.faults.push_back(parse_fault(fault));
  }
  const auto state = std::make_shared<ReplayState>(ReplayState{
      RecordedEvents(recording, output_topics, {components.begin(), components.end()}), {}, {}});
  Host host(host_options);
  auto& source = host.emplace<ReplaySource>(kSource, recording, state);
  for (const std::string& name : components) host.add(name, parameters.child(name));
  auto& map = host.emplace<MapKeeper>("map_keeper");
  auto& comparison = host.emplace<ReplayComparison>("comparison", state, outputs, kSource);
  if (state->events.batch().empty() || source.topics() == 0) {
    throw ConfigError(fmt::format("{}: holds no messages that could be played", recording.name()));
  }
  if (const int exit_code = host.run(); exit_code != 0) return exit_code;
  if (const auto& damage = state->events.damage(); !damage.empty()) {
    for (const Error& error : damage) fmt::print(stderr, "{}\n", printable(error.reason));
    fmt::print(
        stderr,
        "swiftlet: {}: what is damaged was left out, so the outcome would be wrong; `swiftlet "
        "bag verify --repair` makes a sound file of the rest\n",
        recording.name());
    return 1;
  }
  const ReplayResult result = comparison.result();
  if (options.json) {
    fmt::print("{}\n", to_json(result, state->events.inputs()).dump(2));
  } else {
    print(result, options.compare, state->events.inputs(), source.topics());
  }
  if (!options.map.empty()) {
    if (const int code = save(options, map); code != 0) return code;
  }
  return options.compare && result.different > 0 ? 1 : 0;
}

}  // namespace

void add_replay(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* verb =
      app.add_subcommand("replay", "Run components in lockstep on the inputs of a recording");
  verb->add_option("files", options->files, "MCAP file, or the files or folder of a split one")
      ->required();
  verb->add_option("--into", options->into,
                   "Components to run; else those of the recorded flight without the simulator");
  verb->add_flag("--compare", options->compare,
                 "Compare what they publish with the recording; exit code 1 where it differs");
  verb->add_option("--what-if", options->what_if,
                   "Something that goes wrong: \"kill estimator@12.5\", \"delay scan 80ms\", "
                   "\"drop imu0 20%\", the last two with \"@3..4.5\" for a time; may be repeated")
      ->take_all();
  verb->add_option("--map", options->map, "Save the last map here (.pgm with .yaml, or .png)");
  verb->add_flag("--json", options->json, "Print the result as JSON");
  options->parameters.add_to(*verb);
  verb->callback([options] {
    if (const int code = replay(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
