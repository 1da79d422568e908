// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/graph_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/components/introspection/ends.hpp"

namespace swiftlet {
namespace {

using test::reader;
using test::view_of_all;
using test::writer;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names(const std::vector<TopicView>& topics) {
  std::vector<std::string> all;
  for (const TopicView& topic : topics) all.push_back(topic.name);
  return all;
}

TEST(GraphView, LacksTheEndsOfWhoLooks) {
  Graph graph([](const Conflict&) {});
  graph.add(writer("rt/imu0", "sim", test::kImuType, qos::sensor));
  Endpoint own = reader("rt/imu0", "topic_echo");
  graph.add(own);
  Endpoint announcer = writer("ros_discovery_info", "node_announcer");
  announcer.participant = own.participant;
  graph.add(announcer);
  EXPECT_EQ(view_of(graph, "topic_echo", own.participant).endpoints.size(), 1u);
  EXPECT_TRUE(view_of(graph, "topic_echo", own.participant).conflicts.empty());
  EXPECT_EQ(view_of(graph, "topic_echo", "topic_echo.2").endpoints.size(), 3u)
      << "another process of the same name is somebody else";
  EXPECT_EQ(view_of(graph, "other", "other.1").conflicts.size(), 1u);
}

TEST(GraphView, UserDataOfOthersIsNoComponent) {
  Endpoint foreign = writer("rt/imu0", "");
  foreign.component = "typehash=RIHS01_abc;";
  const GraphView view = view_of_all({foreign});
  EXPECT_EQ(view.endpoints[0].component, "");
  EXPECT_EQ(who(view.endpoints[0]), "process rviz2");
}

TEST(GraphView, TopicsHaveTheirEndsTypesAndConflicts) {
  const auto topics =
      topics_of(view_of_all({reader("rt/imu0", "viewer", test::kScanType), writer("rt/imu0", "sim"),
                             reader("rt/imu0", "estimator"), reader("rt/goal", "planner")}),
                "");
  ASSERT_THAT(names(topics), ElementsAre("goal", "imu0"));
  EXPECT_EQ(topics[1].writers.size(), 1u);
  EXPECT_EQ(who(topics[1].readers), "estimator of process estimator.1, viewer of process viewer.1");
  EXPECT_THAT(topics[1].types, ElementsAre("sensor_msgs/msg/Imu", "sensor_msgs/msg/LaserScan"))
      << "what is written comes first";
  ASSERT_EQ(topics[1].conflicts.size(), 1u);
  EXPECT_EQ(topics[1].conflicts[0].reader.component, "viewer");
}

TEST(GraphView, WithAVehicleOnlyItsTopicsAreListed) {
  const GraphView view = view_of_all({writer("rt/uav1/imu0", "a"), writer("rt/uav10/imu0", "b"),
                                      writer("rt/imu0", "c"), writer("HelloWorld", "d")});
  EXPECT_THAT(names(topics_of(view, "uav1")), ElementsAre("imu0"));
  EXPECT_THAT(names(topics_of(view, "")),
              ElementsAre("HelloWorld", "imu0", "uav1/imu0", "uav10/imu0"));
}

TEST(GraphView, ANameMeansTheVehiclesTopicThenTheWholeNameThenTheWire) {
  const GraphView view = view_of_all({writer("rt/uav1/imu0", "a"), writer("rt/imu0", "b"),
                                      writer("rt/scan", "c"), writer("HelloWorld", "d")});
  EXPECT_EQ(find_topic(view, "uav1", "imu0")->wire, "rt/uav1/imu0");
  EXPECT_EQ(find_topic(view, "uav1", "/imu0")->wire, "rt/uav1/imu0");
  EXPECT_EQ(find_topic(view, "", "/imu0")->wire, "rt/imu0");
  EXPECT_EQ(find_topic(view, "", "/uav1/imu0")->wire, "rt/uav1/imu0");
  EXPECT_EQ(find_topic(view, "uav1", "scan")->wire, "rt/scan");
  EXPECT_EQ(find_topic(view, "", "rt/scan")->wire, "rt/scan");
  EXPECT_EQ(find_topic(view, "", "HelloWorld")->wire, "HelloWorld");
}

TEST(GraphView, AMissingTopicIsAnErrorWithTheNearestName) {
  const GraphView view = view_of_all({writer("rt/odometry", "a"), writer("rt/alive/a", "a")});
  EXPECT_THAT(find_topic(view, "", "odometri").error().reason,
              HasSubstr("did you mean 'odometry'"));
  EXPECT_THAT(find_topic(view, "", "zzzzz").error().reason, HasSubstr("topic list"));
  EXPECT_THAT(find_topic(view_of_all({}), "", "x").error().reason, HasSubstr("anything else"));
}

TEST(WeakestOffers, AreWhatAllWritersOfATopicCanKeep) {
  const auto offers =
      weakest_offers({writer("rt/a", "x", test::kImuType, qos::map),
                      writer("rt/a", "y", test::kImuType, qos::state),
                      writer("rt/b", "x", test::kImuType, qos::map),
                      writer("rt/c", "x", test::kImuType, qos::state),
                      writer("rt/c", "y", test::kImuType, qos::sensor), reader("rt/d", "z")});
  ASSERT_EQ(offers.size(), 3u);
  EXPECT_TRUE(offers.at("rt/a").qos.reliable);
  EXPECT_FALSE(offers.at("rt/a").qos.transient_local);
  EXPECT_TRUE(offers.at("rt/b").qos.transient_local);
  EXPECT_FALSE(offers.at("rt/c").qos.reliable);
}

}  // namespace
}  // namespace swiftlet
