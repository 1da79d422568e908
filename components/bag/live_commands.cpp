// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/live_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "components/bag/player.hpp"
#include "components/bag/recorder.hpp"
#include "components/runtime/command_line.hpp"

namespace swiftlet {
namespace {

struct RecordOptions {
  RecorderParams recorder;
  std::string file;
  NetworkOptions network;
};

int record(const RecordOptions& options) {
  RecorderParams params = options.recorder;
  params.file = options.file;
  Host host(options.network.host_options("bag_record"));
  auto& recorder = host.emplace<Recorder>("recorder", params);
  fmt::print("recording to {}; Ctrl-C ends it\n", options.file);
  std::fflush(stdout);
  const int exit_code = host.run();
  const Status closed = recorder.close();
  if (!closed.ok()) {
    fmt::print(stderr, "error: {}\n", closed.error().reason);
    return 1;
  }
  fmt::print("{}: {} messages of {} topics\n", options.file, recorder.statistics().message_count,
             recorder.statistics().channel_count);
  return exit_code;
}

struct PlayOptions {
  std::string file;
  PlayerParams player;
  double start_s = 0.0;
  NetworkOptions network;
};

int play(const PlayOptions& options) {
  const auto reader = mcap::Reader::open(options.file);
  if (!reader.ok()) throw ConfigError(reader.error().reason);
  for (const std::string& topic : options.player.topics) {
    std::vector<std::string> known;
    for (const auto& [id, channel] : reader->channels()) known.push_back(channel.topic);
    if (std::find(known.begin(), known.end(), topic) != known.end()) continue;
    const std::string near = nearest_word(topic, known);
    throw ConfigError(fmt::format("{}: has no topic '{}'; {}", options.file, topic,
                                  near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                                               : fmt::format("did you mean '{}'?", near)));
  }
  PlayerParams params = options.player;
  params.start = from_seconds(options.start_s);
  Host host(options.network.host_options("bag_play"));
  auto& player = host.emplace<Player>("player", *reader, params);
  if (player.channels() == 0) {
    throw ConfigError(fmt::format("{}: holds no messages that could be played", options.file));
  }
  const int exit_code = host.run();
  fmt::print("played {} messages\n", player.played());
  return exit_code;
}

}  // namespace

void add_live_bag_commands(CLI::App& bag) {
  auto record_options = std::make_shared<RecordOptions>();
  CLI::App* record_verb = bag.add_subcommand("record", "Record topics into an MCAP file");
  record_verb->add_option("-o,--output", record_options->file, "MCAP file to write")->required();
  record_verb->add_option("topics", record_options->recorder.topics, "Topics; else all");
  record_verb->add_flag("--overwrite", record_options->recorder.overwrite,
                        "Replace the file where it exists");
  record_options->network.add_to(*record_verb);
  record_verb->callback([record_options] {
    if (const int code = record(*record_options); code != 0) throw CLI::RuntimeError(code);
  });

  auto play_options = std::make_shared<PlayOptions>();
  CLI::App* play_verb = bag.add_subcommand("play", "Publish what was recorded");
  play_verb->add_option("file", play_options->file, "MCAP file")->required();
  play_verb->add_option("--rate", play_options->player.rate, "Times faster than recorded")
      ->check(CLI::PositiveNumber);
  play_verb->add_option("--start", play_options->start_s, "Skip so many seconds")
      ->check(CLI::NonNegativeNumber);
  play_verb->add_option("--topics", play_options->player.topics, "Topics to play; else all");
  play_verb->add_flag("--loop", play_options->player.loop, "Again from the start, until Ctrl-C");
  play_options->network.add_to(*play_verb);
  play_verb->callback([play_options] {
    if (const int code = play(*play_options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
