// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/verbs/command_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "components/runtime/number_check.hpp"
#include "gcs/command/command_client.hpp"
#include "gcs/command/command_watch.hpp"
#include "gcs/sticks/stick_client.hpp"

namespace swiftlet {
namespace {

CommandOutcome until_accepted(const GroundStation& station, const GroundCommand& command,
                              Duration patience, std::string& id) {
  Host host(station.host);
  const auto& client = host.emplace<CommandClient>("gcs", station.name, command, patience);
  host.run();
  id = client.command_id();
  return client.outcome();
}

/// It keeps control meanwhile, and is not missed: a script may be interrupted.
CommandOutcome until_done(const GroundStation& station, const GroundCommand& command,
                          const std::string& id) {
  Terminal terminal;
  Host host(station.host);
  host.emplace<Heartbeat>("heartbeat", station.name, Heartbeat::Absence::kIsNot);
  const auto& client = host.emplace<WaitClient>("gcs", command, id, terminal);
  host.run();
  terminal.clear();
  return client.outcome();
}

}  // namespace

void add_answer_patience(CLI::App& verb, double& patience) {
  verb.add_option("--patience", patience, "For the vehicle's answer; a bad link needs more [s]")
      ->capture_default_str()
      ->check(within(0.1, 3600.0));
}

void CommandOptions::add_to(CLI::App& verb) {
  verb.add_flag("--wait", wait_,
                "End when the vehicle has done it, with exit code 1 where it did not");
  verb.add_flag("--json", json_, "For scripts");
  add_answer_patience(verb, patience_);
}

void CommandOptions::send(const GroundStation& station, const GroundCommand& command) const {
  std::string id;
  CommandOutcome outcome = until_accepted(station, command, from_seconds(patience_), id);
  const bool accepted = outcome.accepted;
  if (accepted && wait_) outcome = until_done(station, command, id);
  if (outcome.text.empty()) {
    outcome.text =
        command.name + (accepted ? ": interrupted; the vehicle goes on with it" : ": interrupted");
  }
  if (json_) {
    const nlohmann::json json = {{"command", command.name},
                                 {"accepted", accepted},
                                 {"done", wait_ && outcome.accepted},
                                 {"text", outcome.text}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print(outcome.accepted ? stdout : stderr, "{}\n", outcome.text);
  }
  if (!outcome.accepted) throw CLI::RuntimeError(1);
}

}  // namespace swiftlet
