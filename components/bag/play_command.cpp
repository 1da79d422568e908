// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "components/bag/bag_info.hpp"
#include "components/bag/live_commands.hpp"
#include "components/bag/player.hpp"
#include "components/runtime/command_line.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/number_check.hpp"
#include "components/terminal/terminal.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSeekStep = 5s;
constexpr double kRateStep = 1.25;
constexpr double kUsualClockHz = 40.0;  // as `ros2 bag play` has it

struct PlayOptions {
  std::vector<std::string> files;
  PlayerParams player;
  double start_s = 0.0;
  double delay_s = 1.0;
  std::vector<std::string> remap;
  std::vector<std::string> qos;
  NetworkOptions network;
};

std::vector<std::string> topics_of(const Recording& recording) {
  std::set<std::string> topics;
  for (const auto& [id, channel] : recording.channels()) {
    topics.insert(without_slash(channel.topic));
  }
  return {topics.begin(), topics.end()};
}

[[noreturn]] void refuse_topic(const Recording& recording, const std::string& option,
                               const std::string& topic) {
  const std::vector<std::string> known = topics_of(recording);
  const std::string near = nearest_word(topic, known);
  throw ConfigError(
      printable(fmt::format("{}: {}has no topic '{}'; {}", recording.name(), option, topic,
                            near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                                         : fmt::format("did you mean '{}'?", near))));
}

void check_topics(const Recording& recording, const TopicPatterns& wanted) {
  const auto missing = TopicSelection(wanted).missing(topics_of(recording));
  if (!missing.empty()) refuse_topic(recording, "", without_slash(missing.front()));
}

/// "old:=new" or "topic=profile", in two parts; the first must be a recorded topic.
std::pair<std::string, std::string> split(const Recording& recording, const std::string& option,
                                          const std::string& text, const std::string& between) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos || at == 0 || at + between.size() == text.size()) {
    throw ConfigError(fmt::format("{} {}: write it as {}", option, text,
                                  between == "=" ? "topic=profile" : "old:=new"));
  }
  const std::string topic = without_slash(text.substr(0, at));
  const auto known = topics_of(recording);
  if (std::find(known.begin(), known.end(), topic) == known.end()) {
    refuse_topic(recording, option + ": ", topic);
  }
  return {topic, text.substr(at + between.size())};
}

QosProfile profile_named(const std::string& text) {
  std::vector<std::string> names;
  for (const QosProfile& profile :
       {qos::sensor, qos::state, qos::command, qos::map, qos::event, qos::bulk}) {
    if (text == profile.name) return profile;
    names.emplace_back(profile.name);
  }
  throw ConfigError(
      fmt::format("--qos: there is no profile '{}'; known are {}", text, fmt::join(names, ", ")));
}

PlayerParams params_of(const PlayOptions& options, const Recording& recording) {
  PlayerParams params = options.player;
  check_topics(recording, {params.topics, {}, {}});
  check_topics(recording, {params.exclude, {}, {}});
  params.start = from_seconds(options.start_s);
  params.delay = from_seconds(options.delay_s);
  for (const std::string& text : options.remap) {
    const auto [old_name, new_name] = split(recording, "--remap", text, ":=");
    const Status valid = check_name(without_slash(new_name));
    if (!valid.ok()) throw ConfigError("--remap " + text + ": " + valid.error().reason);
    params.remap[old_name] = without_slash(new_name);
  }
  for (const std::string& text : options.qos) {
    const auto [topic, profile] = split(recording, "--qos", text, "=");
    params.qos[topic] = profile_named(profile);
  }
  const mcap::Statistics& statistics = recording.statistics();
  const Duration length =
      mcap::to_time(statistics.message_end_time) - mcap::to_time(statistics.message_start_time);
  if (params.start > length) {
    throw ConfigError(fmt::format("--start {}: the recording {} is only {:.3f} s long",
                                  options.start_s, recording.name(), to_seconds(length)));
  }
  return params;
}

/// Lets a person at the terminal see how far it is, and steer it.
class PlayDesk : public Component {
 public:
  PlayDesk(const ComponentContext& context, Player& player, Terminal& terminal)
      : Component(context), player_(player), terminal_(terminal) {
    if (!terminal_.has_keys()) return;
    every(20ms, [this](Time) { take_keys(); });
    every(100ms, [this](Time) { show(); });
  }

 private:
  void take_keys() {
    for (const Key pressed : terminal_.keys()) {
      if (pressed == key(' ')) player_.pause_or_resume();
      if (pressed == key('s') || pressed == key('.')) player_.step();
      if (pressed == Key::kRight) player_.seek(kSeekStep);
      if (pressed == Key::kLeft) player_.seek(-kSeekStep);
      if (pressed == key('+') || pressed == key('=')) player_.scale_rate(kRateStep);
      if (pressed == key('-')) player_.scale_rate(1.0 / kRateStep);
      if (pressed == key('q')) stop(0);
    }
  }

  void show() {
    const Player::Progress progress = player_.progress();
    terminal_.show(
        fmt::format("{} {:.2f} of {:.2f} s, rate {:.3g}, {} messages "
                    "[space: {}, </>: 5 s, s: one message, +/-: rate, q: quit]",
                    progress.paused ? "paused " : "playing", to_seconds(progress.position),
                    to_seconds(progress.length), progress.rate, progress.played,
                    progress.paused ? "go on" : "pause"));
  }

  Player& player_;
  Terminal& terminal_;
};

int play(const PlayOptions& options) {
  const auto recording = Recording::open({options.files.begin(), options.files.end()});
  if (!recording.ok()) throw ConfigError(recording.error().reason);
  for (const Error& error : recording->damage()) {
    fmt::print(stderr, "warning: {}\n", printable(error.reason));
  }
  for (const std::string& missing : missing_parts(*recording)) {
    fmt::print(stderr, "warning: {}\n", printable(missing));
  }
  const PlayerParams params = params_of(options, *recording);
  Host host(options.network.host_options("bag_play"));
  auto& player = host.emplace<Player>("player", *recording, params);
  if (player.topics() == 0) {
    throw ConfigError(fmt::format("{}: holds no messages that could be played", recording->name()));
  }
  Terminal terminal;
  host.emplace<PlayDesk>("desk", player, terminal);
  const int exit_code = host.run();
  terminal.clear();
  fmt::print("played {} messages\n", player.played());
  if (player.damaged_chunks() == 0) return exit_code;
  fmt::print(stderr, "error: {}: damaged chunks that were left out: {}; see swiftlet bag verify\n",
             recording->name(), player.damaged_chunks());
  return 1;
}

}  // namespace

void add_play_command(CLI::App& bag) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* verb = bag.add_subcommand(
      "play",
      "Publish what was recorded. Keys at a terminal: space pauses and resumes, left and "
      "right go 5 s, s or . plays one message, + and - change the rate, q quits");
  verb->add_option("files", options->files, "Recordings (.mcap), or folders of them, played as one")
      ->required();
  verb->add_option("--rate", options->player.rate, "Times faster than recorded")
      ->check(within(1e-3, 1e3))
      ->capture_default_str();
  verb->add_option("--start", options->start_s, "Skip so many seconds")->check(within(0.0, 1e9));
  verb->add_option("--delay", options->delay_s,
                   "Seconds before the first message, for others to find the topics")
      ->check(within(0.0, 3600.0))
      ->capture_default_str();
  verb->add_option("--topics", options->player.topics,
                   "Topics to play, or patterns like 'camera/*'; else all");
  verb->add_option("--exclude", options->player.exclude, "Topics or patterns to leave out");
  verb->add_option("--remap", options->remap, "Play a topic under another name: old:=new");
  verb->add_option("--qos", options->qos,
                   "Play a topic with a profile instead of how it was recorded: topic=sensor (or "
                   "state, command, map, event, bulk)");
  verb->add_option("--clock", options->player.clock_hz,
                   "Publish the recording's time on the topic clock, so many times a second")
      ->expected(0, 1)
      ->default_str(fmt::format("{}", kUsualClockHz))
      ->check(within(0.1, 10'000.0));
  verb->add_flag("--loop", options->player.loop, "Again from the start, until Ctrl-C");
  options->network.add_to(*verb);
  verb->callback([options] {
    if (const int code = play(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

void add_live_bag_commands(CLI::App& bag) {
  add_record_command(bag);
  add_play_command(bag);
}

}  // namespace swiftlet
