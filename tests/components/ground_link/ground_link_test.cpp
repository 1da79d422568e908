// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The ground link between two domains on loopback, in real time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "components/conversions.hpp"
#include "components/ground_link/link_params.hpp"
#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int kVehicleDomain = 77;  // the LOCK of this program keeps both
constexpr int kLinkDomain = 78;

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

ParticipantOptions options(int domain) {
  ParticipantOptions result;
  result.name = "test";
  result.domain = domain;
  return result;
}

template <class T>
EndpointSpec spec(const Topic<T>& topic) {
  const MessageType& type = message_type<T>();
  return {std::string("rt/") + topic.name, type.dds_name(), topic.qos, "test", &type};
}

/// A host with a ground link, running in a thread of its own; one end to talk from on either side.
class GroundLinkComponent : public testing::Test {
 protected:
  void start(const std::string& yaml) {
    HostOptions host_options;
    host_options.participant = options(kVehicleDomain);
    host_ = std::make_unique<Host>(host_options);
    host_->add("ground_link", Config::parse("domain: 78\n" + yaml, "test.yaml"));
    thread_ = std::thread([this] { host_->run(); });
  }
  ~GroundLinkComponent() override {
    if (!thread_.joinable()) return;
    host_->executor().stop(0);
    thread_.join();
  }

  template <class T>
  std::unique_ptr<Writer> writer(Participant& side, const Topic<T>& topic) {
    return side.make_writer(spec(topic));
  }
  template <class T>
  std::unique_ptr<Reader> reader(Participant& side, const Topic<T>& topic) {
    return side.make_reader(spec(topic), [] {});
  }
  static bool matched(const Writer& writer, int readers) {
    return eventually([&] { return writer.matched_readers() >= readers; });
  }

  Participant vehicle_{options(kVehicleDomain)};
  Participant ground_{options(kLinkDomain)};
  std::unique_ptr<Host> host_;
  std::thread thread_;
};

TEST_F(GroundLinkComponent, ListedTopicsCrossOutwardAndNothingElseDoes) {
  const auto status = writer(vehicle_, topic::vehicle_status);
  const auto setpoint = writer(vehicle_, topic::setpoint);
  start("outward: [{topic: vehicle/status, essential: true}]\n");
  const auto heard = reader(ground_, topic::vehicle_status);
  const auto not_heard = reader(ground_, topic::setpoint);
  ASSERT_TRUE(matched(*status, 1));
  ASSERT_TRUE(eventually([&] { return heard->matched_writers() == 1; }));
  swiftlet_msgs::msg::VehicleStatus sent;
  sent.reason("a reason");
  swiftlet_msgs::msg::VehicleStatus received;
  // Again and again: the other end may know us before we know it.
  ASSERT_TRUE(eventually([&] {
    status->write(&sent);
    return heard->take(&received);
  }));
  EXPECT_TRUE(received == sent);
  EXPECT_EQ(not_heard->matched_writers(), 0);
  EXPECT_EQ(setpoint->matched_readers(), 0);
}

TEST_F(GroundLinkComponent, CommandsCrossInwardAsTheyAre) {
  start("inward: [mode]\n");
  const auto heard = reader(vehicle_, topic::mode);
  const auto mode = writer(ground_, topic::mode);
  const auto waypoints = writer(ground_, topic::waypoints);
  ASSERT_TRUE(matched(*mode, 1));
  ASSERT_TRUE(eventually([&] { return heard->matched_writers() == 1; }));
  swiftlet_msgs::msg::ModeCommand sent;
  sent.id("gcs-1");
  swiftlet_msgs::msg::ModeCommand received;
  // Again and again: the other end may know us before we know it.
  ASSERT_TRUE(eventually([&] {
    mode->write(&sent);
    return heard->take(&received);
  }));
  EXPECT_TRUE(received == sent);
  // From now on none is lost, repetitions included.
  sent.id("gcs-2");
  for (int i = 0; i < 3; ++i) mode->write(&sent);
  for (int i = 0; i < 3;) {
    ASSERT_TRUE(eventually([&] { return heard->take(&received); })) << i;
    if (received.id() == "gcs-2") ++i;
  }
  EXPECT_EQ(waypoints->matched_readers(), 0) << "was not listed";
}

TEST_F(GroundLinkComponent, ALateGroundStationGetsTheLatchedMapInTheResolutionThatWasAsked) {
  const auto map = writer(vehicle_, topic::map);
  nav_msgs::msg::OccupancyGrid sent;
  sent.info().resolution(0.05f);
  sent.info().width(400);
  sent.info().height(400);
  sent.data(std::vector<std::int8_t>(160'000, 7));
  map->write(&sent);
  start("outward: [{topic: map, rate: 10, resolution: 0.2}]\n");
  ASSERT_TRUE(matched(*map, 1));
  const auto late = reader(ground_, topic::map);
  nav_msgs::msg::OccupancyGrid received;
  ASSERT_TRUE(eventually([&] { return late->take(&received); }));
  EXPECT_FLOAT_EQ(received.info().resolution(), 0.2f);
  EXPECT_EQ(received.data(), std::vector<std::int8_t>(10'000, 7));
}

TEST_F(GroundLinkComponent, ReportsWhatItDoesOnBothSides) {
  const auto odometry = writer(vehicle_, topic::odometry);
  start(
      "budget: 2000\n"
      "outward: [{topic: diagnostics, essential: true}, {topic: odometry}]\n");
  const auto inside = reader(vehicle_, topic::diagnostics);
  const auto outside = reader(ground_, topic::diagnostics);
  const auto listener = reader(ground_, topic::odometry);
  ASSERT_TRUE(matched(*odometry, 1));
  ASSERT_TRUE(eventually([&] { return listener->matched_writers() == 1; }));
  const auto thinned = [](const diagnostic_msgs::msg::DiagnosticArray& report) {
    for (const auto& status : report.status()) {
      if (status.name() != "ground_link: odometry" || status.level() != 1) continue;
      for (const auto& value : status.values()) {
        if (value.key() == "over_budget_per_s") return std::stoi(value.value()) > 0;
      }
    }
    return false;
  };
  // 700 bytes a hundred times a second are far above the budget.
  const nav_msgs::msg::Odometry message = to_odometry(Time{}, {});
  diagnostic_msgs::msg::DiagnosticArray report;
  bool told_inside = false;
  bool told_outside = false;
  EXPECT_TRUE(eventually([&] {
    odometry->write(&message);
    while (inside->take(&report)) told_inside = told_inside || thinned(report);
    while (outside->take(&report)) told_outside = told_outside || thinned(report);
    return told_inside && told_outside;
  }));
}

TEST(GroundLinkParams, AreCheckedWithFileAndLine) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      const Config config = Config::parse(yaml, "link.yaml");
      read_ground_link(config, 3);
      config.finish();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("domain: 4\n"), "");
  EXPECT_THAT(refusal("budget: 1000\n"), HasSubstr("'domain' is missing"));
  EXPECT_THAT(refusal("domain: 3\n"),
              HasSubstr("link.yaml:1: 'domain' is 3, which is the vehicle's own"));
  EXPECT_THAT(refusal("domain: 4\ninward: [mod]\n"), HasSubstr("link.yaml:2: 'mod'"));
  EXPECT_THAT(refusal("domain: 4\ninward: [mod]\n"), HasSubstr("did you mean 'mode'"));
  EXPECT_THAT(refusal("domain: 4\ninward: [mode]\noutward: [{topic: mode}]\n"),
              HasSubstr("link.yaml:3"));
  EXPECT_THAT(refusal("domain: 4\noutward: [{topic: a b}]\n"), HasSubstr("character"));
  EXPECT_THAT(refusal("domain: 4\noutward: [{topic: map, rat: 1}]\n"),
              HasSubstr("did you mean 'rate'"));
}

}  // namespace
}  // namespace swiftlet
