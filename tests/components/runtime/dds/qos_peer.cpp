// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// qos_peer DOMAIN writer|reader PROFILES.xml TOPIC...
//
// One end of the topics, with the quality of service of the file, until it is killed. Says when its
// endpoints were made, in nanoseconds of the steady clock, then each conflict that it learns of,
// and each sample that arrives.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <set>
#include <thread>
#include <vector>

#include "all_messages.hpp"
#include "components/runtime/dds/participant.hpp"
#include "components/runtime/dds/qos_overrides.hpp"

using namespace swiftlet;
using std_msgs::msg::Header;

namespace {

void say(const std::string& what, const std::string& text) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  fmt::print("{} {} {}\n", what, std::chrono::duration_cast<Duration>(now).count(), text);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 5) return 2;
  const std::vector<std::string> topics(arguments + 4, arguments + count);
  const bool writes = std::string(arguments[2]) == "writer";
  ParticipantOptions options;
  options.name = writes ? "process_w" : "process_r";
  options.domain = std::stoi(arguments[1]);
  options.qos_overrides =
      std::make_shared<const QosOverrides>(QosOverrides::load(arguments[3], {topics, ""}));
  Participant participant(options);

  const MessageType& type = message_type<Header>();
  std::map<std::string, std::unique_ptr<Writer>> writers;
  std::map<std::string, std::unique_ptr<Reader>> readers;
  for (const std::string& topic : topics) {
    const EndpointSpec spec{"rt/" + topic, type.dds_name(), qos::sensor,
                            writes ? "offering" : "asking", &type};
    if (writes) {
      writers[topic] = participant.make_writer(spec);
    } else {
      readers[topic] = participant.make_reader(spec, [] {});
    }
  }
  say("made", "");
  std::set<std::string> known;
  Header header;
  while (true) {
    for (const Conflict& conflict : participant.graph().conflicts()) {
      const std::string text = describe(conflict);
      if (known.insert(text).second) say("conflict", text);
    }
    for (const auto& [topic, writer] : writers) writer->write(&header);
    for (const auto& [topic, reader] : readers) {
      if (reader->take(&header) && known.insert(topic).second) say("sample", topic);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}
