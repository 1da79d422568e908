// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// frame_peer DOMAIN publish
// frame_peer DOMAIN objects|bytes|slow|copies COUNT
//
// The other process of the frame tests: publishes frames until it is killed, or reads COUNT of them
// and says in JSON what it saw.
#include "tests/components/runtime/dds/frame_peer.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;

/// Whether an address belongs to a segment of shared frames.
bool is_shared(const void* address) {
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    char dash = 0;
    std::istringstream(line) >> std::hex >> begin >> dash >> end;
    if (wanted >= begin && wanted < end) return line.find("fast_datasharing") != line.npos;
  }
  return false;
}

void say(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

[[noreturn]] void publish(Participant& participant) {
  const auto writer = participant.make_writer(frame_spec("publisher"));
  say(participant.id());
  for (std::uint32_t number = 0;; ++number) {
    if (void* frame = writer->loan()) {
      fill(number, *static_cast<Frame*>(frame));
      writer->write_loan(frame);
    }
    std::this_thread::sleep_for(5ms);
  }
}

int read(Participant& participant, const std::string& how, int count) {
  const auto reader = participant.make_reader(frame_spec("reader"), [] {});
  say(participant.id());
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  int received = 0;
  int whole = 0;
  int shared = 0;
  int changed = 0;  // while it was being read
  Cdr cdr;
  while (received < count && std::chrono::steady_clock::now() < deadline) {
    const auto use = [&](const void* sample) {
      const auto& frame = *static_cast<const Frame*>(sample);
      ++received;
      const std::uint32_t number = frame.info().width();
      if (how == "slow") std::this_thread::sleep_for(100ms);
      changed += frame.info().width() != number ? 1 : 0;
      whole += is_whole(frame) ? 1 : 0;
      shared += is_shared(sample) ? 1 : 0;
    };
    if (how == "bytes") {
      if (reader->take(cdr)) {
        const auto frame = from_cdr<Frame>(cdr);
        ++received;
        whole += frame.ok() && is_whole(*frame) && to_cdr(*frame) == cdr ? 1 : 0;
      }
    } else {
      reader->take_in_place(use);
    }
    std::this_thread::sleep_for(1ms);
  }
  say(fmt::format(
      R"({{"received": {}, "whole": {}, "shared": {}, "changed": {}, "overwritten": {}}})",
      received, whole, shared, changed, reader->overwritten()));
  return received == count ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::test

int main(int count, char** arguments) {
  using namespace swiftlet;
  const std::string how = count > 2 ? arguments[2] : "";
  if (how.empty() || (how != "publish" && count != 4)) return 2;
  ParticipantOptions options;
  options.name = "frame_peer";
  options.domain = std::stoi(arguments[1]);
  options.shares_memory = how != "copies";
  Participant participant(options);
  if (how == "publish") test::publish(participant);
  return test::read(participant, how, std::stoi(arguments[3]));
}
