// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/screen_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "gcs/screen/shell/screen_component.hpp"
#include "gcs/sticks/stick_client.hpp"

namespace swiftlet {
namespace {

int run_screen(const GroundOptions& network, const screen::CursesTerminal::Options& options) {
  Host host(network.host_options("gcs"));
  // The terminal ends first: the farewell that follows may take a moment.
  screen::CursesTerminal terminal(options);
  screen::ErrorLines errors;
  host.emplace<Heartbeat>("heartbeat", network.station(), Heartbeat::Absence::kIsMissed);
  host.emplace<screen::ScreenComponent>("screen", network.station(), terminal, errors);
  return host.run();
}

}  // namespace

void add_screen(CLI::App& gcs, const std::shared_ptr<GroundOptions>& network) {
  const auto options = std::make_shared<screen::CursesTerminal::Options>();
  gcs.add_flag("--ascii", options->ascii,
               "Of the screen: no other characters, whatever the locale");
  gcs.add_flag_callback(
      "--no-colour", [options] { options->colours = false; }, "Of the screen: no colours");
  network->add_to(gcs);
  gcs.callback([&gcs, network, options] {
    if (!gcs.get_subcommands().empty()) return;
    int code = 0;
    try {
      code = run_screen(*network, *options);
    } catch (const screen::NoTerminal& error) {
      fmt::print(stderr, "gcs: {}\n", error.what());
      code = 2;
    }
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace swiftlet
