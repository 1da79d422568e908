// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "components/introspection/observer.hpp"
#include "components/runtime/command_line.hpp"

namespace swiftlet {

/// Runs one client in a host of its own until it stops, then `done(client, domain)`. Why a client
/// gave up goes to the error stream; an exit code other than 0 is thrown, as verbs do.
template <class Client, class Done, class... Args>
void run_client(const NetworkOptions& network, const char* name, Done done, const Args&... args) {
  // Conflicts between others are for those who ask for them: topic info and doctor.
  logger("graph")->set_level(spdlog::level::off);
  Host host(network.host_options(name));
  auto& client = host.emplace<Client>(name, args...);
  int code = host.run();
  if (client.problem().empty()) {
    code = std::max(code, done(client, host.domain()));
  } else {
    fmt::print(stderr, "error: {}\n", client.problem());
  }
  if (code != 0) throw CLI::RuntimeError(code);
}

/// Prints JSON; texts that are not UTF-8 are shown as far as they are.
inline void print_json(const nlohmann::ordered_json& json) {
  constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;
  fmt::print("{}\n", json.dump(2, ' ', false, replace));
}

/// Looks once and stops.
class Snapshot : public Observer {
 public:
  using Observer::Observer;

 private:
  void begin(const GraphView&) override { stop(0); }
};

}  // namespace swiftlet
