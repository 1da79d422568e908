// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/report_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "components/bag/bag_info.hpp"
#include "components/report/report_page.hpp"
#include "components/report/story_reader.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

constexpr int kFailed = 1;
constexpr int kUnusable = 2;

/// The reason may hold names from a file.
[[noreturn]] void fail(int exit_code, const std::string& reason) {
  fmt::print(stderr, "error: {}\n", printable(reason));
  throw CLI::RuntimeError(exit_code);
}

struct ReportOptions {
  std::vector<std::string> files;
  std::string out;
  std::string vehicle;
};

/// flight.html of flight.mcap, and of a folder flight/.
fs::path page_of(const ReportOptions& options) {
  if (!options.out.empty()) return options.out;
  fs::path path = fs::path(options.files.front()).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  if (path.extension() == ".mcap") return path.replace_extension(".html");
  return path += ".html";
}

/// Refuses a place where no page can be, before the work is done.
void check_page(const fs::path& page, const ReportOptions& options) {
  std::error_code error;
  for (const std::string& file : options.files) {
    if (fs::equivalent(file, page, error)) {
      fail(kUnusable, page.string() + ": is the recording itself; give another name with --out");
    }
  }
  if (fs::is_directory(page, error)) {
    fail(kUnusable, page.string() + ": is a folder; give the name of a file with --out");
  }
  const fs::path folder = page.has_parent_path() ? page.parent_path() : ".";
  if (!fs::is_directory(folder, error)) {
    fail(kUnusable, fmt::format("{}: there is no folder {}; make it, or give another name with "
                                "--out",
                                page.string(), folder.string()));
  }
}

void run_report(const ReportOptions& options) {
  const auto recording = Recording::open({options.files.begin(), options.files.end()});
  if (!recording.ok()) fail(kUnusable, recording.error().reason);
  const fs::path page = page_of(options);
  check_page(page, options);
  const auto story = read_story(*recording, options.vehicle);
  if (!story.ok()) fail(kUnusable, story.error().reason);
  for (const std::string& remark : story->recording.remarks) {
    fmt::print(stderr, "warning: {}\n", printable(remark));
  }
  if (const Status written = write_report(*story, page); !written.ok()) {
    fail(kFailed, written.error().reason);
  }
  fmt::print("{}: {}\n", page.string(), printable(story->outcome.text));
}

}  // namespace

void add_report(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* report = app.add_subcommand(
      "report", "A flight as one HTML page: figures, plots, events, map, sensors, losses");
  report->add_option("files", options->files, "Recordings (.mcap), or folders of them, read as one")
      ->required();
  report->add_option("-o,--out", options->out,
                     "The page, replaced if there; else the recording's name with .html");
  report->add_option("--vehicle", options->vehicle,
                     "Prefix of the topics, where several vehicles are in the recording");
  report->callback([options] { run_report(*options); });
}

}  // namespace swiftlet
