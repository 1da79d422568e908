// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/bag_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/bag/bag_info.hpp"
#include "components/bag/between.hpp"
#include "components/bag/carmen/carmen_log.hpp"
#include "components/bag/convert_carmen.hpp"

namespace swiftlet {
namespace {

constexpr int kFailed = 1;
constexpr int kUnusable = 2;

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

void run_info(const std::string& file, bool json, bool sizes) {
  const auto reader = mcap::Reader::open(file);
  if (!reader.ok()) fail(kUnusable, reader.error().reason);
  if (json) {
    print_json(to_json(*reader, sizes));
  } else {
    fmt::print("{}", describe(*reader, sizes));
  }
  for (const Error& error : reader->damage()) {
    fmt::print(stderr, "warning: {}\n", printable(error.reason));
  }
  // A recording that was cut off is a usable one; one whose bytes changed is not.
  if (reader->finished() && !reader->damage().empty()) {
    fail(kUnusable, file + ": is damaged; `swiftlet bag verify` says what can still be read");
  }
}

void run_verify(const std::string& file, bool json) {
  const auto source = mcap::open_file(file);
  if (!source.ok()) fail(kUnusable, source.error().reason);
  const auto found = mcap::verify(*source);
  if (!found.ok()) fail(kUnusable, found.error().reason);
  if (json) {
    print_json(to_json(file, *found));
  } else {
    fmt::print("{}: {}: {} messages, {} chunks, {} topics\n", file,
               found->problems.empty() ? "sound" : "damaged", found->counted.message_count,
               found->counted.chunk_count, found->counted.channel_count);
  }
  for (const std::string& remark : found->remarks) {
    fmt::print(stderr, "note: {}\n", printable(remark));
  }
  for (const std::string& problem : found->problems) {
    fmt::print(stderr, "error: {}\n", printable(problem));
  }
  if (!found->problems.empty()) throw CLI::RuntimeError(kFailed);
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

/// A command on one recording, with the choice of JSON.
template <class Run>
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& description,
                      Run run) {
  struct Options {
    std::string file;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = parent.add_subcommand(name, description);
  command->add_option("file", options->file, "Recording (.mcap)")->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, run] { run(options->file, options->json); });
  return command;
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
      ->check(between(0.1, 1000.0))
      ->capture_default_str();
  carmen
      ->add_option("--laser-height", options->laser_height,
                   "Height of the scanner, which the log does not have [m]")
      ->check(between(-1000.0, 1000.0))
      ->capture_default_str();
  carmen->callback([options] { run_convert_carmen(*options); });
}

}  // namespace

void add_bag_commands(CLI::App& bag) {
  auto sizes = std::make_shared<bool>(false);
  add_command(bag, "info", "What a recording holds", [sizes](const std::string& file, bool json) {
    run_info(file, json, *sizes);
  })->add_flag("--sizes", *sizes, "Bytes of each topic, too; reads the whole file");
  add_command(bag, "verify", "Check every byte of a recording; exit code 1 if it is damaged",
              run_verify);
  add_convert(bag);
}

}  // namespace swiftlet
