// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// One of many participants: says when it knows all the others.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <set>
#include <thread>

#include "components/runtime/command_line.hpp"
#include "components/runtime/execution/signals.hpp"
#include "components/topics.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  using namespace std::chrono_literals;
  CLI::App app{"One of many participants"};
  NetworkOptions network;
  network.add_to(app);
  int others = 0;
  app.add_option("--others", others, "How many others there are")->required();
  CLI11_PARSE(app, argc, argv);

  const SignalGuard signals;
  const ParticipantOptions options = network.host_options("node").participant;
  Participant participant(options);
  // As many ends as a component has: some topics that all share, some of its own.
  std::vector<std::unique_ptr<Writer>> writers;
  std::vector<std::unique_ptr<Reader>> readers;
  const std::string own = "rt/own_" + std::to_string(getpid()) + "_";
  const MessageType& type = message_type<nav_msgs::msg::Odometry>();
  for (const std::string& topic :
       {std::string("rt/shared_a"), std::string("rt/shared_b"), own + "a", own + "b", own + "c"}) {
    writers.push_back(participant.make_writer({topic, type.dds_name(), qos::state, "node", &type}));
    readers.push_back(
        participant.make_reader({topic, type.dds_name(), qos::state, "node", &type}, [] {}));
  }
  const auto begin = std::chrono::steady_clock::now();
  bool settled = false;
  while (!signals.received()) {
    // A reader of both shared topics in every other process: so many are matched besides our own.
    const bool all =
        writers[0]->matched_readers() > others && writers[1]->matched_readers() > others &&
        readers[0]->matched_writers() > others && readers[1]->matched_writers() > others;
    if (all && !settled) {
      settled = true;
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      std::printf("settled %.3f\n", time.count());
      std::fflush(stdout);
    }
    std::this_thread::sleep_for(20ms);  // thirty of them look around, on two cores
  }
  return settled ? 0 : 1;
}
