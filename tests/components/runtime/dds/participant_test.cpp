// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Two participants in one process: discovery, delivery, quality of service, on real Fast DDS.
#include "components/runtime/dds/participant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "all_messages.hpp"
#include "components/runtime/config/config.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using std_msgs::msg::Header;
using ::testing::HasSubstr;

EndpointSpec spec(const QosProfile& qos, const std::string& component) {
  const MessageType& type = message_type<Header>();
  return {"rt/participant_test", type.dds_name(), qos, component, &type};
}

ParticipantOptions options(const std::string& name, bool isolated = false) {
  ParticipantOptions result;
  result.name = name;
  result.domain = 77;
  result.isolated = isolated;
  return result;
}

Header header(const std::string& frame) {
  Header message;
  message.frame_id(frame);
  return message;
}

/// Waits until `condition` holds, 10 s at most.
template <class Condition>
bool eventually(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

TEST(Participant, SamplesReachAnotherParticipantAsObjectAndAsBytes) {
  Participant a(options("a"));
  Participant b(options("b"));
  const auto writer = a.make_writer(spec(qos::state, "writer"));
  const auto objects = b.make_reader(spec(qos::state, "objects"), [] {});
  const auto bytes = b.make_reader(spec(qos::state, "bytes"), [] {});
  ASSERT_TRUE(eventually([&] { return writer->matched_readers() == 2; }));
  const Header sent = header("hello");
  writer->write(&sent);
  Header received;
  Cdr cdr;
  ASSERT_TRUE(eventually([&] { return objects->take(&received); }));
  ASSERT_TRUE(eventually([&] { return bytes->take(cdr); }));
  EXPECT_TRUE(received == sent);
  EXPECT_EQ(cdr, to_cdr(sent));
  writer->write(cdr);
  ASSERT_TRUE(eventually([&] { return objects->take(&received); }));
  EXPECT_TRUE(received == sent);
}

TEST(Participant, ALateReaderGetsTheLastSampleOfATransientLocalTopic) {
  Participant a(options("a"));
  const auto writer = a.make_writer(spec(qos::map, "mapper"));
  for (const char* frame : {"old", "new"}) {
    const Header message = header(frame);
    writer->write(&message);
  }
  Participant b(options("b"));
  const auto reader = b.make_reader(spec(qos::map, "viewer"), [] {});
  Header received;
  ASSERT_TRUE(eventually([&] { return reader->take(&received); }));
  EXPECT_EQ(received.frame_id(), "new");
}

TEST(Participant, BothEndsLearnOfAConflictByComponentAndProcessName) {
  Participant a(options("process_a"));
  Participant b(options("process_b"));
  const auto writer = a.make_writer(spec(qos::sensor, "careless"));
  const auto reader = b.make_reader(spec(qos::state, "demanding"), [] {});
  for (const Participant* end : {&a, &b}) {
    ASSERT_TRUE(eventually([&] { return !end->graph().conflicts().empty(); }));
    const std::string text = describe(end->graph().conflicts().front());
    EXPECT_THAT(text, HasSubstr("'careless' of process 'process_a'"));
    EXPECT_THAT(text, HasSubstr("'demanding' of process 'process_b'"));
    EXPECT_THAT(text, HasSubstr("reliability"));
  }
}

TEST(Participant, WhoComesLaterFindsAtOnceWhoIsThere) {
  // Fast DDS alone misses the answers to its first announcement in about a third of all cases, and
  // then waits for the next announcement of the others: 1.5 s of ours, 3 s of ROS 2's.
  Participant a(options("a"));
  const auto writer = a.make_writer(spec(qos::state, "writer"));
  int late = 0;
  for (int i = 0; i < 20; ++i) {
    Participant b(options("b"));
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_TRUE(eventually([&] { return !b.graph().endpoints().empty(); }));
    if (std::chrono::steady_clock::now() - begin > 400ms) ++late;
  }
  EXPECT_LE(late, 2) << "of 20; a busy machine may cost one or two";
}

TEST(Participant, WhatIsDiscoveredIsWhatWasSet) {
  QosProfile unusual = qos::command;
  unusual.depth = 17;
  unusual.deadline = 250ms;
  unusual.latency_budget = 3ms;
  unusual.lifespan = 1500ms;
  unusual.liveliness = Liveliness::kByTopic;
  unusual.lease = 7s;
  unusual.exclusive = true;
  unusual.strength = 5;
  Participant a(options("a"));
  Participant b(options("b"));
  const auto writer = a.make_writer(spec(unusual, "somebody"));
  ASSERT_TRUE(eventually([&] { return b.graph().endpoints().size() == 1; }));
  const Endpoint seen = b.graph().endpoints().front();
  EXPECT_EQ(seen.component, "somebody");
  EXPECT_EQ(seen.qos.depth, 17);
  EXPECT_EQ(seen.qos.deadline, 250ms);
  EXPECT_EQ(seen.qos.latency_budget, 3ms);
  EXPECT_EQ(seen.qos.lifespan, 1500ms);
  EXPECT_EQ(seen.qos.liveliness, Liveliness::kByTopic);
  EXPECT_EQ(seen.qos.lease, 7s);
  EXPECT_TRUE(seen.qos.exclusive);
  EXPECT_EQ(seen.qos.strength, 5);
  // Who asks for what is offered, as a recorder does, gets it.
  const auto reader = b.make_reader(spec(seen.qos, "recorder"), [] {});
  EXPECT_TRUE(eventually([&] { return writer->matched_readers() == 1; }));
}

TEST(Participant, EndpointsThatGoAreForgotten) {
  Participant a(options("a"));
  auto b = std::make_unique<Participant>(options("b"));
  auto writer = b->make_writer(spec(qos::state, "writer"));
  ASSERT_TRUE(eventually([&] { return a.graph().endpoints().size() == 1; }));
  writer.reset();
  EXPECT_TRUE(eventually([&] { return a.graph().endpoints().empty(); }));
}

TEST(Participant, AnIsolatedOneDeliversInTheWritersThread) {
  Participant alone(options("alone", true));
  const auto writer = alone.make_writer(spec(qos::state, "writer"));
  std::atomic<bool> same_thread{false};
  const auto reader = alone.make_reader(
      spec(qos::state, "reader"),
      [&, id = std::this_thread::get_id()] { same_thread = std::this_thread::get_id() == id; });
  const Header sent = header("x");
  writer->write(&sent);
  EXPECT_TRUE(same_thread) << "must have been called by write(), at once";
  Header received;
  EXPECT_TRUE(reader->take(&received));
}

TEST(Participant, OneTopicWithTwoTypesIsRefused) {
  Participant a(options("a", true));
  const auto writer = a.make_writer(spec(qos::state, "writer"));
  EndpointSpec other = spec(qos::state, "other");
  other.message_type = &message_type<sensor_msgs::msg::Imu>();
  other.type = other.message_type->dds_name();
  EXPECT_THROW(a.make_reader(other, [] {}), RuntimeError);
}

TEST(Domain, ComesFromTheEnvironmentAndIsChecked) {
  const char* before = std::getenv("ROS_DOMAIN_ID");
  const std::string kept = before == nullptr ? "" : before;
  setenv("ROS_DOMAIN_ID", "42", 1);
  EXPECT_EQ(domain_from_environment(), 42);
  for (const char* bad : {"233", "-1", "x", "4 2", " 5", "+5", "99999999999"}) {
    setenv("ROS_DOMAIN_ID", bad, 1);
    EXPECT_THROW(domain_from_environment(), ConfigError) << bad;
  }
  setenv("ROS_DOMAIN_ID", kept.c_str(), 1);
}

}  // namespace
}  // namespace swiftlet
