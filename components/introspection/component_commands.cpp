// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "components/introspection/client_run.hpp"
#include "components/introspection/introspection_commands.hpp"
#include "components/introspection/status_observer.hpp"
#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

struct Options {
  std::string component;
  bool available = false;
  bool json = false;
  NetworkOptions network;
};

/// Those that this program can host.
void list_available(bool json) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const auto& entry : ComponentRegistry::instance().entries()) {
    if (!json) fmt::print("{:20} {}\n", entry.name, entry.summary);
    array.push_back({{"component", entry.name}, {"summary", entry.summary}});
  }
  if (json) print_json(array);
}

void list(const Options& options) {
  if (options.available) return list_available(options.json);
  const auto print = [&](StatusObserver& observer, int domain) {
    if (options.json) {
      print_json(instances_json(observer.instances(), observer.end()));
    } else if (observer.instances().empty()) {
      fmt::print(stderr,
                 "note: no component is running: {}. Those that this program can host: swiftlet "
                 "component list --available\n",
                 nothing_there(domain));
    } else {
      fmt::print("{}", instances_text(observer.instances(), observer.vehicle(), observer.end()));
    }
    return 0;
  };
  run_client<StatusObserver>(options.network, "component_list", print, kListen);
}

int not_running(const std::string& component, const StatusObserver& observer, int domain) {
  std::vector<std::string> running;
  for (const Instance& instance : observer.instances()) {
    running.push_back(instance.name(observer.vehicle()));
  }
  const std::string near = nearest_word(component, running);
  const bool can_host = ComponentRegistry::instance().find(component) != nullptr;
  fmt::print(stderr, "error: nobody runs '{}'; {}{}\n", component,
             running.empty() ? nothing_there(domain)
             : near.empty()  ? fmt::format("running are {}", fmt::join(running, ", "))
                             : fmt::format("did you mean '{}'?", near),
             can_host ? fmt::format(". Start it: swiftlet run {}", component) : "");
  return 1;
}

void info(const Options& options) {
  const auto print = [&](StatusObserver& observer, int domain) {
    const Time now = observer.end();
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    std::string text;
    for (const Instance& instance : observer.instances()) {
      if (instance.name(observer.vehicle()) != options.component &&
          instance.component != options.component) {
        continue;
      }
      text += instance_text(instance, observer.last_view(), observer.vehicle(), now);
      array.push_back(instance_json(instance, observer.last_view(), observer.vehicle(), now));
    }
    if (array.empty()) return not_running(options.component, observer, domain);
    if (options.json) {
      print_json(array);
    } else {
      fmt::print("{}", text);
    }
    return 0;
  };
  run_client<StatusObserver>(options.network, "component_info", print, kListen);
}

}  // namespace

void add_component_commands(CLI::App& app) {
  CLI::App* component = app.add_subcommand("component", "Components: running, and of this program");
  component->require_subcommand(1);
  {
    auto options = std::make_shared<Options>();
    CLI::App* verb = component->add_subcommand("list", "Running components, and how they are");
    verb->add_flag("--available", options->available, "Those that this program can host instead");
    verb->add_flag("--json", options->json, "For scripts");
    options->network.add_to(*verb);
    verb->callback([options] { list(*options); });
  }
  auto options = std::make_shared<Options>();
  CLI::App* verb = component->add_subcommand("info", "One component: what it reads and writes");
  verb->add_option("component", options->component, "For instance planner")->required();
  verb->add_flag("--json", options->json, "For scripts");
  options->network.add_to(*verb);
  verb->callback([options] { info(*options); });
}

}  // namespace swiftlet
