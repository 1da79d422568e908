// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/mission_file_verbs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/runtime/number_check.hpp"
#include "gcs/mission/mission_check.hpp"
#include "gcs/mission/mission_file.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "perception/map_io.hpp"

namespace swiftlet {
namespace {

struct ValidateOptions {
  std::string file;
  std::string map;
  std::vector<double> takeoff;
  MissionReading reading;
  MissionCheckParams params;
  bool json = false;
};

[[noreturn]] void refuse(const std::string& reason) {
  end_verb(kExitUnusable, reason);
}

MissionFile load(const std::string& file, const MissionReading& reading) {
  Result<MissionFile> mission = read_mission(file, reading);
  if (!mission.ok()) refuse(mission.error().reason);
  return std::move(*mission);
}

std::string at_line(const std::string& file, int line) {
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

void print_remarks(std::FILE* stream, const std::string& file,
                   const std::vector<MissionRemark>& remarks) {
  for (const MissionRemark& remark : merged(remarks)) {
    fmt::print(stream, "{}: note: {}\n", at_line(file, remark.line), remark.text);
  }
}

std::size_t count(const MissionCheck& check, MissionFinding::Severity severity) {
  std::size_t number = 0;
  for (const MissionFinding& finding : check.findings) number += finding.severity == severity;
  return number;
}

std::string to_json(const std::string& file, const MissionFile& mission,
                    const MissionCheck& check) {
  nlohmann::json json = {{"file", file},
                         {"name", mission.name},
                         {"items", mission.items.size()},
                         {"length_m", check.length},
                         {"duration_s", check.duration},
                         {"usable", !check.has_errors()},
                         {"findings", nlohmann::json::array()},
                         {"remarks", nlohmann::json::array()}};
  for (const MissionFinding& finding : check.findings) {
    const bool is_error = finding.severity == MissionFinding::Severity::kError;
    json["findings"].push_back({{"severity", is_error ? "error" : "warning"},
                                {"item", finding.item},
                                {"line", finding.line},
                                {"text", finding.text}});
  }
  for (const MissionRemark& remark : mission.remarks) {
    json["remarks"].push_back({{"line", remark.line}, {"text", remark.text}});
  }
  // Names of files and missions may hold any bytes.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_text(const std::string& file, const MissionFile& mission, const MissionCheck& check) {
  print_remarks(stdout, file, mission.remarks);
  for (const MissionFinding& finding : check.findings) {
    fmt::print("{}\n", describe(finding, file));
  }
  const auto number_of = [](auto number, const std::string& what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  fmt::print("{}: {}, {:.0f} m, {:.0f} s; {}, {}\n", file, number_of(mission.items.size(), "item"),
             check.length, check.duration,
             number_of(count(check, MissionFinding::Severity::kError), "error"),
             number_of(count(check, MissionFinding::Severity::kWarning), "warning"));
}

void validate(ValidateOptions options) {
  const MissionFile mission = load(options.file, options.reading);
  OccupancyGrid grid;
  if (!options.map.empty()) {
    Result<OccupancyGrid> map = load_map(options.map);
    if (!map.ok()) refuse(map.error().reason);
    grid = std::move(*map);
    options.params.map = &grid;
  }
  if (!options.takeoff.empty()) {
    options.params.takeoff.head<2>() = Eigen::Vector2d(options.takeoff[0], options.takeoff[1]);
  }
  const MissionCheck check = check_mission(mission, options.params);
  if (options.json) {
    fmt::print("{}\n", to_json(options.file, mission, check));
  } else {
    print_text(options.file, mission, check);
  }
  if (check.has_errors()) throw CLI::RuntimeError(kExitFailed);
}

void convert(const std::string& input, const std::string& output, const MissionReading& reading) {
  if (const auto form = mission_form_of(output); !form.ok()) refuse(form.error().reason);
  const MissionFile mission = load(input, reading);
  print_remarks(stderr, input, mission.remarks);
  const auto written = write_mission(output, mission);
  if (!written.ok()) end_verb(kExitFailed, written.error().reason);
  print_remarks(stderr, output, *written);
  fmt::print("{}: {} items\n", output, mission.items.size());
}

void add_home_altitude(CLI::App& verb, MissionReading& reading) {
  verb.add_option("--home-altitude", reading.home_altitude,
                  "Of the take-off point above sea [m], for files with altitudes above sea and no "
                  "home")
      ->check(within(-1e4, 1e4));
}

void add_validate(CLI::App& mission) {
  const auto options = std::make_shared<ValidateOptions>();
  MissionCheckParams& params = options->params;
  CLI::App* verb = mission.add_subcommand(
      "validate", "Look for what is wrong with a mission file, as a whole, without a vehicle");
  verb->add_option("file", options->file, "MISSION.yaml, .plan or .waypoints")->required();
  verb->add_option("--map", options->map, "MAP.yaml, as map_server has it: known obstacles");
  verb->add_option("--takeoff", options->takeoff,
                   "x y of the take-off point in the map [m]; else 0 0")
      ->expected(2)
      ->check(within(-1e4, 1e4));
  verb->add_option("--fence-radius", params.fence.radius, "Around the take-off point [m]")
      ->check(within(0.1, 1e6));
  verb->add_option("--fence-height", params.fence.height, "Above the take-off point [m]")
      ->check(within(0.1, 1e6));
  verb->add_option("--clearance", params.clearance, "From the vehicle's centre to obstacles [m]")
      ->capture_default_str()
      ->check(within(0.0, 10.0));
  verb->add_option("--max-speed", params.most_speed, "Of any waypoint [m/s]")
      ->check(within(0.1, 50.0));
  verb->add_option("--endurance", params.endurance, "Of a full battery in the air [s]")
      ->check(within(1.0, 1e5));
  verb->add_option("--charge", params.charge, "Of the battery at take-off, 0 to 1")
      ->capture_default_str()
      ->check(within(0.0, 1.0));
  verb->add_option("--reserve", params.reserve, "Of the battery after landing, 0 to 1")
      ->capture_default_str()
      ->check(within(0.0, 1.0));
  add_home_altitude(*verb, options->reading);
  verb->add_flag("--json", options->json, "For scripts");
  verb->footer("Exit codes: 0 it can be flown, 1 it has errors, 2 a file cannot be used.");
  verb->callback([options] { validate(*options); });
}

void add_convert(CLI::App& mission) {
  struct Options {
    std::string input, output;
    MissionReading reading;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* verb = mission.add_subcommand(
      "convert", "From one form to another, by what the names end with; says what is lost");
  verb->add_option("input", options->input, "MISSION.yaml, .plan or .waypoints")->required();
  verb->add_option("output", options->output, "The same; it is replaced where it exists")
      ->required();
  add_home_altitude(*verb, options->reading);
  verb->callback([options] { convert(options->input, options->output, options->reading); });
}

}  // namespace

void add_mission_file_verbs(CLI::App& mission) {
  add_validate(mission);
  add_convert(mission);
}

}  // namespace swiftlet
