// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/bag_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "components/bag/bag_info.hpp"
#include "components/bag/carmen/carmen_log.hpp"
#include "components/bag/convert_carmen.hpp"
#include "components/bag/repair_file.hpp"
#include "components/runtime/number_check.hpp"

namespace swiftlet {
namespace {

constexpr int kFailed = 1;
constexpr int kUnusable = 2;
constexpr const char* kFilesHelp = "Recordings (.mcap), or folders of them, read as one";

/// Ends the command. The reason may hold names from a file.
[[noreturn]] void fail(int exit_code, const std::string& reason) {
  fmt::print(stderr, "error: {}\n", printable(reason));
  throw CLI::RuntimeError(exit_code);
}

void print_json(const nlohmann::json& json) {
  // Names in a file need not be UTF-8.
  constexpr auto replace = nlohmann::json::error_handler_t::replace;
  fmt::print("{}\n", json.dump(2, ' ', false, replace));
}

using Files = std::vector<std::string>;

Recording open_recording(const Files& files) {
  auto recording = Recording::open({files.begin(), files.end()});
  if (!recording.ok()) fail(kUnusable, recording.error().reason);
  return std::move(*recording);
}

void run_info(const Files& files, bool json, bool sizes) {
  const Recording recording = open_recording(files);
  if (json) {
    print_json(to_json(recording, sizes));
  } else {
    fmt::print("{}", describe(recording, sizes));
  }
  for (const Error& error : recording.damage()) {
    fmt::print(stderr, "warning: {}\n", printable(error.reason));
  }
  for (const std::string& missing : missing_parts(recording)) {
    fmt::print(stderr, "warning: {}\n", printable(missing));
  }
  // A recording that was cut off is a usable one; one whose bytes changed is not.
  for (const mcap::Reader& file : recording.files()) {
    if (file.finished() && !file.damage().empty()) {
      fail(kUnusable, file.name() +
                          ": is damaged; `swiftlet bag verify` says what can still be read, with "
                          "--repair it saves that");
    }
  }
}

struct VerifyOptions {
  Files files;
  bool json = false;
  bool repair = false;
  std::string output;
};

/// Whether the file is sound now.
bool repair_one(const std::string& file, const VerifyOptions& options, nlohmann::json& report) {
  const auto repaired = repair_file(
      file, options.output.empty() ? std::nullopt
                                   : std::make_optional<std::filesystem::path>(options.output));
  if (!repaired.ok()) {
    fmt::print(stderr, "error: {}\n", printable(repaired.error().reason));
    return false;
  }
  const mcap::Repair& repair = repaired->repair;
  report["repair"] = to_json(*repaired);
  if (!options.json) {
    fmt::print("{}: repaired: {} messages are saved{}\n", repaired->file.string(),
               repair.saved.message_count,
               repaired->kept
                   ? fmt::format("; the damaged file is kept as {}", repaired->kept->string())
                   : "");
  }
  for (const std::string& problem : repair.problems) {
    fmt::print(stderr, "warning: not saved: {}\n", printable(problem));
  }
  return true;
}

bool verify_one(const std::string& file, const VerifyOptions& options, nlohmann::json& reports) {
  const auto source = mcap::open_file(file);
  if (!source.ok()) fail(kUnusable, source.error().reason);
  const auto found = mcap::verify(*source);
  // What does not even begin as MCAP may hold chunks that can be saved.
  if (!found.ok() && !options.repair) fail(kUnusable, found.error().reason);
  nlohmann::json report = {{"file", file}, {"sound", false}};
  if (found.ok()) report = to_json(file, *found);
  bool sound = found.ok() && found->problems.empty();
  if (found.ok() && !options.json) {
    fmt::print("{}: {}: {} messages, {} chunks, {} topics\n", file, sound ? "sound" : "damaged",
               found->counted.message_count, found->counted.chunk_count,
               found->counted.channel_count);
  }
  for (const std::string& remark : found.ok() ? found->remarks : std::vector<std::string>()) {
    fmt::print(stderr, "note: {}\n", printable(remark));
  }
  if (!sound && options.repair) {
    sound = repair_one(file, options, report);
  } else if (!sound) {
    for (const std::string& problem : found->problems) {
      fmt::print(stderr, "error: {}\n", printable(problem));
    }
  }
  reports.push_back(std::move(report));
  return sound;
}

void run_verify(const VerifyOptions& options) {
  const auto files = recording_files({options.files.begin(), options.files.end()});
  if (!files.ok()) fail(kUnusable, files.error().reason);
  if (!options.output.empty() && !options.repair) {
    fail(kUnusable, "-o is where --repair puts the sound file; add --repair");
  }
  if (!options.output.empty() && files->size() > 1) {
    fail(kUnusable, "-o takes the repair of one file; repair several in place, or one by one");
  }
  auto reports = nlohmann::json::array();
  bool all_sound = true;
  for (const auto& file : *files) {
    const bool sound = verify_one(file.string(), options, reports);
    all_sound = all_sound && sound;
  }
  if (files->size() > 1) {
    const auto recording = Recording::open(*files);
    for (const std::string& missing :
         recording.ok() ? missing_parts(*recording) : std::vector<std::string>()) {
      fmt::print(stderr, "error: {}\n", printable(missing));
      all_sound = false;
    }
  }
  if (options.json) print_json(files->size() == 1 ? reports.front() : reports);
  if (!all_sound) throw CLI::RuntimeError(kFailed);
}

struct ConvertOptions {
  std::string log;
  std::string output;
  carmen::Params params;
  double laser_height = kUsualLaserHeight;
};

void run_convert_carmen(const ConvertOptions& options) {
  std::error_code error;
  if (std::filesystem::equivalent(options.log, options.output, error)) {
    fail(kUnusable, options.output + ": is the log itself; give another name for the recording");
  }
  const auto log = carmen::read_log(options.log, options.params);
  if (!log.ok()) fail(kUnusable, log.error().reason);
  const auto done = convert_carmen(*log, options.output, options.laser_height);
  if (!done.ok()) fail(kFailed, done.error().reason);
  fmt::print("{}: {} scans, {} poses ({}), {} lines of other kinds skipped\n", options.output,
             done->scans, done->poses, done->corrected ? "corrected" : "raw odometry",
             done->skipped_lines);
}

void add_info(CLI::App& bag) {
  struct Options {
    Files files;
    bool json = false;
    bool sizes = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* info = bag.add_subcommand("info", "What a recording holds");
  info->add_option("files", options->files, kFilesHelp)->required();
  info->add_flag("--json", options->json, "Print JSON");
  info->add_flag("--sizes", options->sizes, "Bytes of each topic, too; reads the whole file");
  info->callback([options] { run_info(options->files, options->json, options->sizes); });
}

void add_verify(CLI::App& bag) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* verify =
      bag.add_subcommand("verify", "Check every byte of a recording; exit code 1 if it is damaged");
  verify->add_option("files", options->files, kFilesHelp)->required();
  verify->add_flag("--json", options->json, "Print JSON");
  verify->add_flag("--repair", options->repair,
                   "Make a sound file of what can be read; the damaged one stays as FILE.damaged");
  verify->add_option("-o,--output", options->output,
                     "Where --repair puts the sound file; the damaged one is not touched");
  verify->callback([options] { run_verify(*options); });
}

void add_convert(CLI::App& bag) {
  CLI::App* convert = bag.add_subcommand("convert", "Make a recording of a log of another format");
  convert->require_subcommand(1);
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* carmen = convert->add_subcommand(
      "carmen", "CARMEN laser log: topics scan and odometry (corrected poses if it has them)");
  carmen->add_option("log", options->log, "CARMEN log (.log or .log.gz)")->required();
  carmen->add_option("-o,--output", options->output, "Recording to make (.mcap), replaced if there")
      ->required();
  carmen
      ->add_option("--max-range", options->params.max_range,
                   "Ranges from here on are no return [m]")
      ->check(within(0.1, 1000.0))
      ->capture_default_str();
  carmen
      ->add_option("--laser-height", options->laser_height,
                   "Height of the scanner, which the log does not have [m]")
      ->check(within(-1000.0, 1000.0))
      ->capture_default_str();
  carmen->callback([options] { run_convert_carmen(*options); });
}

}  // namespace

void add_bag_commands(CLI::App& bag) {
  add_info(bag);
  add_verify(bag);
  add_convert(bag);
}

}  // namespace swiftlet
