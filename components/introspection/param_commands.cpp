// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "components/introspection/client_run.hpp"
#include "components/introspection/introspection_commands.hpp"
#include "components/introspection/parameter_client.hpp"
#include "components/introspection/parameter_text.hpp"

namespace swiftlet {
namespace {

namespace request = swiftlet_msgs::msg::ParameterRequest_Constants;

struct Options {
  ParameterQuery query;
  bool json = false;
  NetworkOptions network;
};

/// Says what went wrong; the exit code that follows from it.
int report_failures(const ParameterClient& client) {
  for (const auto& reply : client.replies()) {
    if (reply.accepted()) continue;
    fmt::print(stderr, "error: {} of process {}: {}\n", reply.component_name(), reply.process(),
               reply.reason());
  }
  for (const std::string& party : client.silent()) {
    fmt::print(stderr,
               "error: {} does not answer; is it stopped or very busy? See: swiftlet "
               "component list\n",
               party);
  }
  const bool interrupted = client.replies().empty() && client.silent().empty();
  const bool all_accepted = std::all_of(client.replies().begin(), client.replies().end(),
                                        [](const auto& reply) { return reply.accepted(); });
  return !interrupted && all_accepted && client.silent().empty() ? 0 : 1;
}

ParameterReplies accepted(const ParameterClient& client) {
  ParameterReplies replies;
  for (const auto& reply : client.replies()) {
    if (reply.accepted()) replies.push_back(reply);
  }
  return replies;
}

template <class Print>
void ask(const Options& options, std::uint8_t command, Print print) {
  ParameterQuery query = options.query;
  query.command = command;
  const auto done = [&](ParameterClient& client, int) {
    if (options.json) {
      print_json(parameters_json(client.replies()));
    } else {
      print(accepted(client));
    }
    return report_failures(client);
  };
  run_client<ParameterClient>(options.network, "param", done, query);
}

void list(const Options& options) {
  ask(options, request::LIST,
      [](const ParameterReplies& replies) { fmt::print("{}", parameters_text(replies)); });
}

void get(const Options& options) {
  ask(options, request::GET, [](const ParameterReplies& replies) {
    for (const auto& reply : replies) {
      if (replies.size() > 1) fmt::print("{}: ", reply.process());
      for (const auto& parameter : reply.parameters()) fmt::print("{}\n", parameter.value());
    }
  });
}

void set(const Options& options) {
  ask(options, request::SET, [](const ParameterReplies& replies) {
    for (const auto& reply : replies) {
      for (const auto& parameter : reply.parameters()) {
        fmt::print("{} of process {}: {} is now {}\n", reply.component_name(), reply.process(),
                   parameter.name(), parameter.value());
      }
    }
  });
}

void dump(const Options& options) {
  ask(options, request::LIST, [](const ParameterReplies& replies) {
    std::vector<std::string> differing;
    fmt::print("{}", parameters_yaml(replies, differing));
    for (const std::string& component : differing) {
      fmt::print(stderr, "warning: the instances of {} differ; these are the values of one\n",
                 component);
    }
  });
}

CLI::App* add_verb(CLI::App& param, const char* name, const char* what,
                   const std::shared_ptr<Options>& options, void (*run)(const Options&)) {
  CLI::App* verb = param.add_subcommand(name, what);
  verb->add_flag("--json", options->json, "For scripts");
  options->network.add_to(*verb);
  verb->callback([options, run] { run(*options); });
  return verb;
}

}  // namespace

void add_param_commands(CLI::App& app) {
  CLI::App* param = app.add_subcommand("param", "Parameters of running components");
  param->require_subcommand(1);
  const auto add = [&](const char* name, const char* what, void (*run)(const Options&)) {
    auto options = std::make_shared<Options>();
    return std::make_pair(add_verb(*param, name, what, options, run), options);
  };
  const auto [list_verb, list_options] = add("list", "Values, limits, and which may be set", list);
  list_verb->add_option("component", list_options->query.component, "Else all");
  const auto [get_verb, get_options] = add("get", "The value of one", get);
  get_verb->add_option("component", get_options->query.component, "For instance planner")
      ->required();
  get_verb->add_option("name", get_options->query.name, "For instance max_speed")->required();
  const auto [set_verb, set_options] =
      add("set", "Set one while its component runs; param list says which", set);
  set_verb->add_option("component", set_options->query.component, "For instance planner")
      ->required();
  set_verb->add_option("name", set_options->query.name, "For instance max_speed")->required();
  set_verb->add_option("value", set_options->query.value, "As in YAML")->required();
  const auto [dump_verb, dump_options] = add("dump", "YAML that --params reads", dump);
  dump_verb->add_option("component", dump_options->query.component, "Else all");
}

}  // namespace swiftlet
