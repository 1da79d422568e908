// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "components/introspection/client_run.hpp"
#include "components/introspection/diagnosis.hpp"
#include "components/introspection/introspection_commands.hpp"
#include "components/introspection/status_observer.hpp"
#include "components/runtime/number_check.hpp"

namespace swiftlet {
namespace {

struct Options {
  double wait_s = to_seconds(kListen);
  bool json = false;
  NetworkOptions network;
};

void examine(const Options& options) {
  const auto done = [&](StatusObserver& observer, int domain) {
    if (observer.end() == Time{}) return 1;  // interrupted
    const Evidence evidence{observer.last_view(), observer.instances(), observer.vehicle(), domain,
                            observer.end()};
    const auto findings = diagnose(evidence);
    if (options.json) {
      print_json(findings_json(findings));
    } else {
      fmt::print("{}", findings_text(findings, evidence));
    }
    const bool sick = std::any_of(findings.begin(), findings.end(),
                                  [](const Finding& finding) { return finding.is_problem; });
    return sick ? 1 : 0;
  };
  run_client<StatusObserver>(options.network, "doctor", done, from_seconds(options.wait_s));
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(
      "doctor", "What is wrong with the running system; exit code 1 if anything");
  verb->add_option("--wait", options->wait_s, "Seconds to listen to what components say")
      ->check(within(0.1, 3600.0))
      ->capture_default_str();
  verb->add_flag("--json", options->json, "For scripts");
  options->network.add_to(*verb);
  verb->callback([options] { examine(*options); });
}

}  // namespace swiftlet
