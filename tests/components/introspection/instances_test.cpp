// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/instances.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "components/runtime/message.hpp"
#include "swiftlet_msgs.h"
#include "tests/components/introspection/ends.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

Cdr status(const std::string& component, const std::string& process, bool active, unsigned standby,
           const std::vector<std::string>& problems = {}) {
  swiftlet_msgs::msg::ComponentStatus message;
  message.component_name(component);
  message.process(process);
  message.active(active);
  message.standby(standby);
  message.period(0.02);
  message.problems(problems);
  return to_cdr(message);
}

TEST(Instances, StatusTopicsTellTheVehicle) {
  std::string vehicle = "?";
  EXPECT_TRUE(is_status_topic("rt/component/status", &vehicle));
  EXPECT_EQ(vehicle, "");
  EXPECT_TRUE(is_status_topic("rt/fleet/uav1/component/status", &vehicle));
  EXPECT_EQ(vehicle, "fleet/uav1");
  EXPECT_TRUE(is_status_topic("rt/uav1/alive/planner", &vehicle));
  EXPECT_EQ(vehicle, "uav1");
  EXPECT_FALSE(is_status_topic("rt/mycomponent/status"));
  EXPECT_FALSE(is_status_topic("rt/component/status/more"));
  EXPECT_FALSE(is_status_topic("rt/undead/x"));
}

TEST(Instances, SignsOfLifeDoNotTakeProblemsBack) {
  InstanceBook book;
  book.note("rt/component/status", status("planner", "a", true, 0, {"map: nobody writes it"}),
            Time(1s));
  book.note("rt/alive/planner", status("planner", "a", true, 0), Time(2s));
  const auto all = book.all({}, "");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_THAT(all[0].problems, ElementsAre("map: nobody writes it"));
  EXPECT_EQ(all[0].heard, Time(2s));
  book.note("rt/component/status", status("planner", "a", true, 0), Time(3s));
  EXPECT_TRUE(book.all({}, "")[0].problems.empty());
  book.note("rt/component/status", {0, 1, 0, 0, 9}, Time(3s));
  EXPECT_EQ(book.all({}, "").size(), 1u) << "bytes that are no status are nobody";
}

TEST(Instances, TheActiveOneComesFirstAndSilenceIsSaid) {
  InstanceBook book;
  book.note("rt/component/status", status("planner", "a", false, 0), Time(1s));
  book.note("rt/component/status", status("planner", "b", true, 1), Time(1s));
  auto all = book.all({}, "");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].process, "b");
  EXPECT_EQ(all[0].state(Time(1s + 200ms)), "active");
  EXPECT_EQ(all[1].state(Time(1s)), "standby 0");
  EXPECT_EQ(all[0].state(Time(1s + 260ms)), "silent");
  EXPECT_THAT(instances_text(all, "", Time(2s)), HasSubstr("not heard for 1.00 s"));
  EXPECT_EQ(instances_json(all, Time(2s))[0]["active"], false);
  EXPECT_EQ(instances_json(all, Time(1s))[0]["active"], true);
}

TEST(Instances, SomeAreKnownFromTheGraphOnly) {
  InstanceBook book;
  book.note("rt/component/status", status("sim", "sim.1", true, 0), Time(1s));
  const GraphView view = test::view_of_all(
      {test::writer("rt/imu0", "sim"), test::reader("rt/imu0", "recorder"),
       test::writer("ros_discovery_info", "node_announcer"), test::reader("rt/imu0", "")});
  const auto all = book.all(view, "");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].component, "recorder");
  EXPECT_EQ(all[0].state(Time(1s)), "-");
  EXPECT_EQ(all[1].component, "sim");
}

TEST(Instances, OfVehiclesAreToldApart) {
  InstanceBook book;
  book.note("rt/uav1/component/status", status("sim", "p", true, 0), Time(1s));
  book.note("rt/uav2/component/status", status("sim", "p", true, 0), Time(1s));
  EXPECT_EQ(book.all({}, "").size(), 2u);
  EXPECT_EQ(book.all({}, "")[0].name(""), "uav1/sim");
  ASSERT_EQ(book.all({}, "uav2").size(), 1u);
  EXPECT_EQ(book.all({}, "uav2")[0].name("uav2"), "sim");
}

TEST(Instances, InfoNamesWhoIsAtTheOtherSide) {
  InstanceBook book;
  book.note("rt/component/status", status("sim", "sim.1", true, 0), Time(1s));
  const GraphView view =
      test::view_of_all({test::writer("rt/imu0", "sim"), test::reader("rt/motors", "sim"),
                         test::reader("rt/imu0", "estimator")});
  const Instance sim = book.all(view, "")[1];
  const std::string text = instance_text(sim, view, "", Time(1s));
  EXPECT_THAT(text, HasSubstr("writes imu0 [sensor_msgs/msg/Imu] (reliable, volatile) -> estimator "
                              "of process estimator.1"));
  EXPECT_THAT(text,
              HasSubstr("reads  motors [sensor_msgs/msg/Imu] (reliable, volatile) <- nobody"));
  const auto json = instance_json(sim, view, "", Time(1s));
  EXPECT_EQ(json["writes"][0]["readers"][0], "estimator of process estimator.1");
  EXPECT_TRUE(json["reads"][0]["writers"].empty());
}

}  // namespace
}  // namespace swiftlet
