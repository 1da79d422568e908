// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "components/runtime/number_check.hpp"
#include "gcs/verbs/battery_view.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

struct Options {
  double seconds = 2.0;
  bool json = false;
};

void show(const NetworkOptions& network, const Options& options) {
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<BatteryClient>("gcs", from_seconds(options.seconds));
  host.run();
  if (!client.view()) {
    end_verb(kExitFailed, fmt::format("no battery is heard in domain {} for {:g} s; is --vehicle "
                                      "right? What there is: swiftlet topic list",
                                      host.domain(), options.seconds));
  }
  fmt::print("{}", options.json ? to_json(*client.view()) : describe(*client.view()));
}

}  // namespace

void add_battery_verb(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = gcs.add_subcommand("battery", "Its charge, and how long it lasts");
  verb->add_option("--seconds", options->seconds, "Listen so long for what is not known yet [s]")
      ->capture_default_str()
      ->check(within(0.5, 3600.0));
  verb->add_flag("--json", options->json, "For scripts; null where something is not known");
  verb->footer(
      "Time left is the charge over the current, or, where the battery does not measure these, the "
      "slope of its\npercentage, which takes half a minute in flight: --seconds 60. ? is not "
      "known.");
  network->add_to(*verb);
  verb->callback([network, options] { show(*network, *options); });
}

}  // namespace swiftlet
