// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <memory>

#include "components/bag/live_commands.hpp"
#include "components/bag/recorder.hpp"
#include "components/terminal/terminal.hpp"
#include "components/bag/units.hpp"
#include "components/runtime/command_line.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

struct RecordOptions {
  RecorderParams recorder;
  std::string file;
  std::string split_size;
  std::string split_duration;
  std::string window;
  std::string max_memory = "256MB";
  NetworkOptions network;
};

constexpr std::uint64_t kLeastMemory = 4'000'000;

RecorderParams params_of(const RecordOptions& options) {
  RecorderParams params = options.recorder;
  params.file = options.file;
  if (!options.split_size.empty()) {
    params.split_size = parse_size("--split-size", options.split_size);
  }
  if (!options.split_duration.empty()) {
    params.split_duration = parse_duration("--split-duration", options.split_duration);
  }
  if (!options.window.empty()) params.window = parse_duration("--window", options.window);
  params.max_memory = parse_size("--max-memory", options.max_memory);
  if (params.max_memory < kLeastMemory) {
    throw ConfigError(
        fmt::format("--max-memory {}: is less than {} MB, with which nothing large "
                    "can be recorded",
                    options.max_memory, kLeastMemory / 1'000'000));
  }
  return params;
}

// A signal handler can reach nothing but a global.
std::atomic<bool> g_save{false};
void note_save(int) {
  g_save = true;
}

/// Tells a person at the terminal how the recording goes, and takes wishes: by key and by signal.
class RecordDesk : public Component {
 public:
  RecordDesk(const ComponentContext& context, Recorder& recorder, Terminal& terminal,
             bool has_window)
      : Component(context), recorder_(recorder), terminal_(terminal) {
    if (has_window) {
      std::signal(SIGUSR1, note_save);
      every(50ms, [this](Time) { look_for_wishes(); });
    }
    if (terminal_.has_status()) {
      every(500ms, [this, has_window](Time now) { show(now, has_window); });
    }
  }
  ~RecordDesk() override { std::signal(SIGUSR1, SIG_DFL); }

 private:
  void look_for_wishes() {
    if (g_save.exchange(false)) recorder_.save();
    for (const Key pressed : terminal_.keys()) {
      if (pressed == key('s')) recorder_.save();
    }
  }

  void show(Time now, bool has_window) {
    const Recorder::Progress progress = recorder_.progress();
    const double seconds = to_seconds(now - shown_);
    const double rate = static_cast<double>(progress.bytes - shown_bytes_) / seconds;
    shown_ = now;
    shown_bytes_ = progress.bytes;
    const std::uint64_t lost = progress.lost_by_dds + progress.dropped;
    terminal_.show(fmt::format("{} messages of {} topics, {:.1f} MB/s, {} {:.1f} MB, {}",
                               progress.messages, progress.topics, 1e-6 * rate,
                               has_window ? "window" : "queue",
                               1e-6 * static_cast<double>(progress.queued_bytes),
                               lost == 0 ? "nothing lost"
                                         : fmt::format("lost: {} by DDS, {} by the recorder",
                                                       progress.lost_by_dds, progress.dropped)) +
                   (has_window ? fmt::format(", {} saved (s saves)", progress.saved) : ""));
  }

  Recorder& recorder_;
  Terminal& terminal_;
  Time shown_ = now();
  std::uint64_t shown_bytes_ = 0;
};

void print_losses(const LossLedger& losses) {
  for (const auto& [topic, loss] : losses) {
    fmt::print(stderr,
               "warning: {}: {} messages are missing: DDS lost {}, the recorder dropped {}\n",
               topic, loss.total(), loss.by_dds, loss.by_recorder);
  }
}

int record(const RecordOptions& options) {
  const RecorderParams params = params_of(options);
  const bool has_window = params.window > Duration(0);
  Host host(options.network.host_options("bag_record"));
  auto& recorder = host.emplace<Recorder>("recorder", params);
  Terminal terminal;
  host.emplace<RecordDesk>("desk", recorder, terminal, has_window);
  if (has_window) {
    fmt::print("keeping the last {} s; SIGUSR1 to process {} saves them, Ctrl-C ends\n",
               to_seconds(params.window), ::getpid());
  } else {
    fmt::print("recording to {}; Ctrl-C ends it\n", options.file);
  }
  std::fflush(stdout);
  const int exit_code = host.run();
  terminal.clear();
  const Status closed = recorder.close();
  const Recorder::Progress progress = recorder.progress();
  for (const auto& file : recorder.files()) {
    if (recorder.files().size() > 1 || has_window) fmt::print("{}\n", file.string());
  }
  if (has_window && recorder.files().empty()) fmt::print("nothing was saved\n");
  fmt::print("{}: {} messages of {} topics\n", options.file,
             progress.messages - (has_window ? 0 : progress.dropped), progress.topics);
  print_losses(recorder.losses());
  for (const std::string& topic : recorder.missing()) {
    fmt::print(stderr, "warning: nobody published the topic {}\n", topic);
  }
  if (closed.ok()) return exit_code;
  fmt::print(stderr, "error: {}\n", closed.error().reason);
  return 1;
}

}  // namespace

void add_record_command(CLI::App& bag) {
  auto options = std::make_shared<RecordOptions>();
  RecorderParams& recorder = options->recorder;
  CLI::App* verb = bag.add_subcommand("record", "Record topics into an MCAP file");
  verb->add_option("-o,--output", options->file, "MCAP file to write")->required();
  verb->add_option("topics", recorder.topics,
                   "Topics, or patterns like 'camera/*' and 'camera/**'; else all");
  verb->add_option("--regex", recorder.regexes, "Topics that match a regular expression, too");
  verb->add_option("--exclude", recorder.exclude, "Topics or patterns to leave out");
  verb->add_flag("--overwrite", recorder.overwrite, "Replace the file where it exists");
  const std::map<std::string, mcap::Compression> compressions = {
      {"none", mcap::Compression::kNone},
      {"lz4", mcap::Compression::kLz4},
      {"zstd", mcap::Compression::kZstd}};
  verb->add_option("--compression", recorder.compression, "none, lz4 or zstd (the default)")
      ->transform(CLI::CheckedTransformer(compressions))
      ->option_text("NAME");
  auto* window = verb->add_option(
      "--window", options->window,
      "Keep only the last 30s (or 10min, ...) in memory; SIGUSR1 or the key s saves them");
  verb->add_option("--split-size", options->split_size,
                   "Begin a new file F_0.mcap, F_1.mcap, ... after 500MB (or 2GB, ...)")
      ->excludes(window);
  verb->add_option("--split-duration", options->split_duration,
                   "Begin a new file after 10min (or 30s, ...)")
      ->excludes(window);
  verb->add_option("--max-memory", options->max_memory,
                   "For samples that wait for the disk, or are kept in the window")
      ->capture_default_str();
  options->network.add_to(*verb);
  verb->callback([options] {
    if (const int code = record(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
