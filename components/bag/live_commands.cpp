// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/live_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "components/bag/bag_info.hpp"
#include "components/bag/between.hpp"
#include "components/bag/player.hpp"
#include "components/runtime/command_line.hpp"

namespace swiftlet {
namespace {

struct PlayOptions {
  std::string file;
  PlayerParams player;
  double start_s = 0.0;
  double delay_s = 1.0;
  NetworkOptions network;
};

void check_topics(const mcap::Reader& reader, const std::vector<std::string>& wanted) {
  std::vector<std::string> known;
  for (const auto& [id, channel] : reader.channels()) {
    const bool has_slash = !channel.topic.empty() && channel.topic[0] == '/';
    known.push_back(channel.topic.substr(has_slash ? 1 : 0));
  }
  for (const std::string& topic : wanted) {
    const std::string name = topic.substr(!topic.empty() && topic[0] == '/' ? 1 : 0);
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_word(name, known);
    throw ConfigError(
        printable(fmt::format("{}: has no topic '{}'; {}", reader.name(), topic,
                              near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                                           : fmt::format("did you mean '{}'?", near))));
  }
}

int play(const PlayOptions& options) {
  const auto reader = mcap::Reader::open(options.file);
  if (!reader.ok()) throw ConfigError(reader.error().reason);
  for (const Error& error : reader->damage()) {
    fmt::print(stderr, "warning: {}\n", printable(error.reason));
  }
  check_topics(*reader, options.player.topics);
  PlayerParams params = options.player;
  params.start = from_seconds(options.start_s);
  params.delay = from_seconds(options.delay_s);
  const mcap::Statistics& statistics = reader->statistics();
  const Duration length =
      mcap::to_time(statistics.message_end_time) - mcap::to_time(statistics.message_start_time);
  if (params.start > length) {
    throw ConfigError(fmt::format("--start {}: the recording {} is only {:.3f} s long",
                                  options.start_s, options.file, to_seconds(length)));
  }
  Host host(options.network.host_options("bag_play"));
  auto& player = host.emplace<Player>("player", *reader, params);
  if (player.channels() == 0) {
    throw ConfigError(fmt::format("{}: holds no messages that could be played", options.file));
  }
  const int exit_code = host.run();
  fmt::print("played {} messages\n", player.played());
  if (player.damaged_chunks() == 0) return exit_code;
  fmt::print(stderr, "error: {}: damaged chunks that were left out: {}; see swiftlet bag verify\n",
             options.file, player.damaged_chunks());
  return 1;
}

}  // namespace

void add_live_bag_commands(CLI::App& bag) {
  add_record_command(bag);

  auto play_options = std::make_shared<PlayOptions>();
  CLI::App* play_verb = bag.add_subcommand("play", "Publish what was recorded");
  play_verb->add_option("file", play_options->file, "MCAP file")->required();
  play_verb->add_option("--rate", play_options->player.rate, "Times faster than recorded")
      ->check(between(1e-3, 1e3))
      ->capture_default_str();
  play_verb->add_option("--start", play_options->start_s, "Skip so many seconds")
      ->check(between(0.0, 1e9));
  play_verb
      ->add_option("--delay", play_options->delay_s,
                   "Seconds before the first message, for others to find the topics")
      ->check(between(0.0, 3600.0))
      ->capture_default_str();
  play_verb->add_option("--topics", play_options->player.topics, "Topics to play; else all");
  play_verb->add_flag("--loop", play_options->player.loop, "Again from the start, until Ctrl-C");
  play_options->network.add_to(*play_verb);
  play_verb->callback([play_options] {
    if (const int code = play(*play_options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
