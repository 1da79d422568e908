// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/launch/launch_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/launch/supervisor.hpp"
#include "components/launch/system_file.hpp"

namespace swiftlet {
namespace {

struct LaunchOptions {
  std::string file;
  std::string host;
  bool dry_run = false;
  bool json = false;
};

void print(const std::vector<CommandLine>& lines, bool as_json) {
  if (!as_json) {
    for (const CommandLine& line : lines) fmt::print("{}: {}\n", line.name, quoted(line.words));
    return;
  }
  nlohmann::json json = nlohmann::json::array();
  for (const CommandLine& line : lines) {
    json.push_back({{"name", line.name}, {"command", line.words}});
  }
  fmt::print("{}\n", json.dump(2));
}

int launch(const LaunchOptions& options) {
  const SystemFile system = SystemFile::load(options.file);
  const HostSpec& host = system.host(options.host);
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::vector<CommandLine> lines = command_lines(system, host, program);
  if (lines.empty()) {
    throw ConfigError(
        fmt::format("{}: nothing runs on this host; give it 'components'", options.file));
  }
  if (options.dry_run) {
    print(lines, options.json);
    return 0;
  }
  return Supervisor(lines, {system.restart, system.stop_on_failure, system.stop_timeout}).run();
}

}  // namespace

void add_launch(CLI::App& app) {
  auto options = std::make_shared<LaunchOptions>();
  CLI::App* verb = app.add_subcommand(
      "launch", "Run what a system file gives to this host, and keep it running");
  verb->add_option("file", options->file, "System file (YAML)")->required();
  verb->add_option("--host", options->host,
                   "Host of the file to be; else the only one, else the one with this machine's "
                   "name");
  CLI::Option* dry_run = verb->add_flag("--dry-run", options->dry_run,
                                        "Only check the file and print what would be run");
  verb->add_flag("--json", options->json, "For scripts")->needs(dry_run);
  verb->callback([options] {
    if (const int code = launch(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
