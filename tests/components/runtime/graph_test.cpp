// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swiftlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Endpoint endpoint(const std::string& id, bool is_writer, const QosProfile& qos,
                  const std::string& type = "sensor_msgs::msg::dds_::Imu_") {
  return {id, "rt/imu0", type, is_writer, qos, is_writer ? "sim" : "estimator", "p" + id};
}

struct GraphTest : ::testing::Test {
  std::vector<Conflict> reported;
  Graph graph{[this](const Conflict& conflict) { reported.push_back(conflict); }};
};

TEST_F(GraphTest, FittingEndsAreNoConflict) {
  graph.add(endpoint("1", true, qos::state));
  graph.add(endpoint("2", false, qos::sensor));
  graph.add(endpoint("3", true, qos::map));
  EXPECT_TRUE(reported.empty());
  EXPECT_EQ(graph.endpoints().size(), 3u);
}

TEST_F(GraphTest, QosConflictIsReportedOnceAndNamesPolicyAndBothEnds) {
  graph.add(endpoint("1", true, qos::sensor));
  graph.add(endpoint("2", false, qos::state));
  graph.add(endpoint("2", false, qos::state));  // announced again
  ASSERT_EQ(reported.size(), 1u);
  EXPECT_THAT(
      describe(reported[0]),
      AllOf(HasSubstr("rt/imu0"), HasSubstr("offered best effort, requested reliable"),
            HasSubstr("'sim'"), HasSubstr("'estimator'"), HasSubstr("p1"), HasSubstr("p2")));
  graph.remove("1");
  EXPECT_TRUE(graph.conflicts().empty());
}

TEST_F(GraphTest, DurabilityAndTypeConflictsAreFoundWhicheverEndComesFirst) {
  graph.add(endpoint("1", false, qos::map));
  graph.add(endpoint("2", true, qos::state));
  graph.add(endpoint("3", true, qos::map, "std_msgs::msg::dds_::Header_"));
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_THAT(reported[0].problem, HasSubstr("durability"));
  EXPECT_THAT(reported[1].problem,
              AllOf(HasSubstr("std_msgs/msg/Header"), HasSubstr("sensor_msgs/msg/Imu")));
}

TEST_F(GraphTest, PartitionsMustMeetAndMayBePatterns) {
  const auto problem = [](const std::vector<std::string>& offered,
                          const std::vector<std::string>& requested) {
    std::string found;
    Graph two([&](const Conflict& conflict) { found = conflict.problem; });
    Endpoint writer = endpoint("1", true, qos::state);
    writer.partitions = offered;
    Endpoint reader = endpoint("2", false, qos::state);
    reader.partitions = requested;
    two.add(writer);
    two.add(reader);
    return found;
  };
  EXPECT_EQ(problem({}, {}), "");
  EXPECT_EQ(problem({"a", "b"}, {"b"}), "");
  EXPECT_EQ(problem({"uav*"}, {"uav1"}), "");
  EXPECT_EQ(problem({"uav1"}, {"uav*"}), "");
  EXPECT_EQ(problem({""}, {}), "");
  EXPECT_EQ(problem({"a", "b"}, {"c"}), "partition: offered 'a', 'b', requested 'c'");
  EXPECT_EQ(problem({}, {"c"}), "partition: offered the default one, requested 'c'");
}

}  // namespace
}  // namespace swiftlet
