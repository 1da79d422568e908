// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// departure_peer DOMAIN writer|reader [TIMES]
//
// The writer sends large reliable samples in bursts that no reader keeps up with, until it is
// killed: without the pauses, nine of ten datagrams are lost for nothing on a slow machine. The
// reader comes, hears one sample and leaves, so many times; exit code 1 where it hears nothing for
// five seconds.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "components/runtime/dds/participant.hpp"

using namespace swiftlet;

namespace {

EndpointSpec endpoint(const char* component) {
  QosProfile qos = qos::keeping(qos::event, 32);
  qos.large = true;
  return {"rt/burst", "test::msg::dds_::Blob_", qos, component, nullptr};
}

constexpr int kBurst = 10;  // samples
constexpr std::chrono::milliseconds kPause(5);

int write(Participant& participant) {
  const auto writer = participant.make_writer(endpoint("speaker"));
  Cdr sample{0, 1, 0, 0};
  sample.resize(500'000);
  while (true) {
    for (int i = 0; i < kBurst && writer->matched_readers() > 0; ++i) writer->write(sample);
    std::this_thread::sleep_for(kPause);
  }
}

bool hear(Participant& participant) {
  std::atomic<bool> heard{false};
  const auto reader = participant.make_reader(endpoint("listener"), [&] { heard = true; });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (!heard && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return heard;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return 2;
  ParticipantOptions options;
  options.name = arguments[2];
  options.domain = std::stoi(arguments[1]);
  Participant participant(options);
  if (options.name == "writer") return write(participant);
  for (int i = 0; i < std::stoi(arguments[3]); ++i) {
    if (hear(participant)) continue;
    std::printf("nothing was heard at the %d. time\n", i);
    return 1;
  }
  return 0;
}
