// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/topic_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/components/introspection/ends.hpp"

namespace swiftlet {
namespace {

using test::reader;
using test::writer;
using testing::HasSubstr;
using testing::Not;

std::vector<TopicView> topics() {
  return topics_of(
      test::view_of_all({writer("rt/imu0", "sim", test::kImuType, qos::sensor),
                         reader("rt/imu0", "estimator"),
                         reader("rt/scan", "mapper", test::kScanType),
                         writer("rq/serviceRequest", ""), writer("rt/alive/sim", "sim")}),
      "");
}

TEST(TopicText, ListsAsMuchAsIsAskedFor) {
  EXPECT_EQ(list_text(topics(), {}), "imu0\nscan\n");
  EXPECT_EQ(list_text(topics(), {true, false, false}),
            "imu0 [sensor_msgs/msg/Imu]\nscan [sensor_msgs/msg/LaserScan]\n");
  EXPECT_EQ(list_text(topics(), {false, true, false}),
            "imu0: 1 writer, 1 reader, 1 conflict\nscan: 0 writers, 1 reader\n");
  EXPECT_THAT(list_text(topics(), {false, false, true}), HasSubstr("rq/serviceRequest"));
  EXPECT_EQ(list_json(topics(), false).size(), 2u);
  EXPECT_EQ(list_json(topics(), false)[0]["conflicts"], 1);
}

TEST(TopicText, InfoNamesBothEndsOfAConflict) {
  const TopicView imu = topics().at(1);
  ASSERT_EQ(imu.name, "imu0");
  const std::string text = info_text(imu, false);
  EXPECT_THAT(text, HasSubstr("sim of process sim.1: best effort, volatile"));
  EXPECT_THAT(text, HasSubstr("nothing flows from sim of process sim.1 to estimator of process "
                              "estimator.1: reliability: offered best effort, requested reliable"));
  EXPECT_THAT(text, Not(HasSubstr("sim.1|rt/imu0w")));
  EXPECT_THAT(info_text(imu, true), HasSubstr("id    sim.1|rt/imu0w"));
  const auto json = info_json(imu);
  EXPECT_EQ(json["writers"][0]["component"], "sim");
  EXPECT_EQ(json["readers"][0]["reliable"], true);
  EXPECT_THAT(json["conflicts"][0]["problem"], HasSubstr("reliability"));
}

}  // namespace
}  // namespace swiftlet
