// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <memory>

#include "components/introspection/client_run.hpp"
#include "components/introspection/echo.hpp"
#include "components/introspection/introspection_commands.hpp"
#include "components/introspection/topic_meter.hpp"
#include "components/introspection/topic_text.hpp"
#include "components/runtime/number_check.hpp"
#include "components/runtime/reflection/idl_files.hpp"

namespace swiftlet {
namespace {

struct ListOptions {
  TopicListOptions list;
  bool json = false;
  NetworkOptions network;
};

void list(const ListOptions& options) {
  run_client<Snapshot>(options.network, "topic_list", [&](Snapshot& snapshot, int domain) {
    const auto topics = topics_of(snapshot.first_view(), snapshot.vehicle());
    if (options.json) {
      print_json(list_json(topics, options.list.all));
      return 0;
    }
    const std::string text = list_text(topics, options.list);
    fmt::print("{}", text);
    if (text.empty()) fmt::print(stderr, "note: {}\n", nothing_there(domain));
    return 0;
  });
}

struct InfoOptions {
  std::string topic;
  bool verbose = false;
  bool json = false;
  NetworkOptions network;
};

/// Finds one topic and stops.
class TopicFinder : public Observer {
 public:
  TopicFinder(const ComponentContext& context, std::string topic)
      : Observer(context), topic_(std::move(topic)) {}
  const TopicView& found() const { return found_; }

 private:
  void begin(const GraphView& view) override {
    const Result<TopicView> found = find_topic(view, vehicle(), topic_);
    if (!found.ok()) return give_up(found.error().reason);
    found_ = *found;
    stop(0);
  }

  std::string topic_;
  TopicView found_;
};

void info(const InfoOptions& options) {
  const auto print = [&](TopicFinder& finder, int) {
    if (finder.found().wire.empty()) return 1;  // interrupted
    if (options.json) {
      print_json(info_json(finder.found()));
    } else {
      fmt::print("{}", info_text(finder.found(), options.verbose));
    }
    return 0;
  };
  run_client<TopicFinder>(options.network, "topic_info", print, options.topic);
}

struct EchoOptions {
  EchoParams echo;
  std::vector<std::string> idl_files;
  bool once = false;
  bool no_lists = false;
  NetworkOptions network;
};

/// The types of this program and those that the user's files define on top of them.
TypeLibrary library_with(const std::vector<std::string>& paths) {
  std::vector<IdlFile> files = idl_files();
  for (const std::string& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw ConfigError(fmt::format("--idl {}: cannot be read", path));
    files.push_back({path, std::move(text)});
  }
  auto library = TypeLibrary::parse(files);
  if (!library.ok()) throw ConfigError(library.error().reason);
  return std::move(library).value();
}

void echo(const EchoOptions& options) {
  EchoParams params = options.echo;
  params.lists = !options.no_lists;
  if (options.once) params.count = 1;
  std::optional<TypeLibrary> library;
  if (!options.idl_files.empty()) params.types = &library.emplace(library_with(options.idl_files));
  const auto done = [&](Echo& client, int) { return client.printed() < params.count ? 1 : 0; };
  run_client<Echo>(options.network, "topic_echo", done, params);
}

struct MeterOptions {
  MeterParams meter;
  bool once = false;
  NetworkOptions network;
};

template <class Meter>
void measure(const MeterOptions& options, const char* name) {
  MeterParams params = options.meter;
  if (options.once) params.count = 1;
  run_client<Meter>(
      options.network, name, [](Meter&, int) { return 0; }, params);
}

void add_list(CLI::App& topic) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* verb = topic.add_subcommand("list", "Topics that somebody writes or reads");
  verb->add_flag("-t,--types", options->list.types, "With their types");
  verb->add_flag("-v,--verbose", options->list.counts, "With the numbers of writers and readers");
  verb->add_flag("--all", options->list.all, "Those of ROS 2's services and graph, too");
  verb->add_flag("--json", options->json, "For scripts");
  options->network.add_to(*verb);
  verb->callback([options] { list(*options); });
}

void add_info(CLI::App& topic) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* verb =
      topic.add_subcommand("info", "Type of a topic, who writes and reads it, and how");
  verb->add_option("topic", options->topic, "Topic, for instance odometry")->required();
  verb->add_flag("-v,--verbose", options->verbose, "With the identity of each end");
  verb->add_flag("--json", options->json, "For scripts");
  options->network.add_to(*verb);
  verb->callback([options] { info(*options); });
}

void add_echo(CLI::App& topic) {
  auto options = std::make_shared<EchoOptions>();
  CLI::App* verb = topic.add_subcommand("echo", "Print the messages of a topic, until Ctrl-C");
  verb->add_option("topic", options->echo.topic, "Topic, for instance odometry")->required();
  CLI::Option* once = verb->add_flag("--once", options->once, "One message, then end");
  verb->add_option("--count", options->echo.count, "So many messages, then end")
      ->check(whole_within(1, 1'000'000'000))
      ->excludes(once);
  verb->add_option("--field", options->echo.field,
                   "Only this part: pose.pose.position, ranges[17]");
  verb->add_flag("--json", options->echo.json, "A line of JSON a message");
  verb->add_flag("--no-arr", options->no_lists, "Only type and length of arrays and sequences");
  verb->add_flag("--full-length", options->echo.full_length,
                 "All elements of long lists, all characters of long texts");
  verb->add_option("--idl", options->idl_files, "IDL files of types that this program lacks");
  options->network.add_to(*verb);
  verb->callback([options] { echo(*options); });
}

template <class Meter>
void add_meter(CLI::App& topic, const char* name, const char* component, const char* what) {
  auto options = std::make_shared<MeterOptions>();
  CLI::App* verb = topic.add_subcommand(name, what);
  verb->add_option("topic", options->meter.topic, "Topic, for instance odometry")->required();
  verb->add_option("--window", options->meter.window, "Messages that a report is about, at most")
      ->check(whole_within(2, 10'000'000))
      ->capture_default_str();
  CLI::Option* once = verb->add_flag("--once", options->once, "One report, then end");
  verb->add_option("--count", options->meter.count, "So many reports, then end")
      ->check(whole_within(1, 1'000'000'000))
      ->excludes(once);
  verb->add_flag("--json", options->meter.json, "A line of JSON a report");
  options->network.add_to(*verb);
  verb->callback([options, component] { measure<Meter>(*options, component); });
}

}  // namespace

void add_topic_commands(CLI::App& app) {
  CLI::App* topic = app.add_subcommand("topic", "Topics of a running system");
  topic->require_subcommand(1);
  add_list(*topic);
  add_info(*topic);
  add_echo(*topic);
  add_meter<RateMeter>(*topic, "hz", "topic_hz", "How often messages come, a report a second");
  add_meter<BandwidthMeter>(*topic, "bw", "topic_bw", "Bytes a second, a report a second");
}

}  // namespace swiftlet
