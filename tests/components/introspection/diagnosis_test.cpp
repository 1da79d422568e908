// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/components/introspection/ends.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using test::reader;
using test::writer;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Time kNow(100s);

Instance instance(const std::string& component, bool active = true) {
  Instance result;
  result.component = component;
  result.process = component + ".1";
  result.has_status = true;
  result.active = active;
  result.period = 20ms;
  result.heard = kNow - 10ms;
  return result;
}

Evidence evidence(const std::vector<Endpoint>& ends, const std::vector<Instance>& instances = {}) {
  return {test::view_of_all(ends), instances, "", 7, kNow};
}

/// A small system that works.
std::vector<Endpoint> sound() {
  return {writer("rt/imu0", "sim"), reader("rt/imu0", "estimator"),
          writer("rt/component/status", "sim"), writer("rt/component/status", "estimator")};
}
std::vector<Instance> both() {
  return {instance("sim"), instance("estimator")};
}

std::vector<std::string> kinds(const std::vector<Finding>& findings) {
  std::vector<std::string> all;
  for (const Finding& finding : findings) {
    all.push_back(finding.kind);
    EXPECT_FALSE(finding.text.empty());
    EXPECT_FALSE(finding.remedy.empty()) << finding.text;
  }
  return all;
}

TEST(Diagnosis, AllIsWell) {
  const auto findings = diagnose(evidence(sound(), both()));
  EXPECT_THAT(kinds(findings), IsEmpty());
  EXPECT_THAT(findings_text(findings, evidence(sound(), both())), HasSubstr("healthy (2 comp"));
  EXPECT_EQ(findings_json(findings)["healthy"], true);
}

TEST(Diagnosis, NothingThereAtAll) {
  const auto findings = diagnose(evidence({}));
  ASSERT_THAT(kinds(findings), ElementsAre("nothing"));
  EXPECT_THAT(findings[0].text, HasSubstr("domain 7"));
  EXPECT_THAT(findings[0].remedy, AllOf(HasSubstr("ROS_DOMAIN_ID"), HasSubstr("--network")));
  Evidence other = evidence(sound(), both());
  other.vehicle = "uav1";
  EXPECT_THAT(kinds(diagnose(other)), Contains("nothing")) << "it is another vehicle's";
}

TEST(Diagnosis, ConflictsNameBothEnds) {
  auto ends = sound();
  ends.push_back(writer("rt/scan", "sim", test::kScanType, qos::sensor));
  ends.push_back(reader("rt/scan", "mapper", test::kScanType, qos::state));
  ends.push_back(reader("rt/imu0", "viewer", test::kScanType));
  const auto findings = diagnose(evidence(ends, both()));
  ASSERT_THAT(kinds(findings), testing::UnorderedElementsAre("qos", "type"));
  for (const Finding& finding : findings) {
    EXPECT_TRUE(finding.is_problem);
    EXPECT_THAT(finding.text, HasSubstr("from sim of process sim.1 to "));
  }
}

TEST(Diagnosis, ATopicThatIsReadAndNotWritten) {
  auto ends = sound();
  ends.push_back(reader("rt/phone/pose", "estimator", test::kScanType));
  auto instances = both();
  instances[1].problems = {"phone/pose: nobody writes it", "imu0: 3 Hz"};
  auto findings = diagnose(evidence(ends, instances));
  ASSERT_THAT(kinds(findings), ElementsAre("unwritten", "problem")) << "said once";
  EXPECT_THAT(findings[0].text, AllOf(HasSubstr("'phone/pose'"), HasSubstr("estimator.1")));
  EXPECT_THAT(findings[1].text, HasSubstr("imu0: 3 Hz"));
  // Another vehicle's name in front, the same type: that is what people forget.
  ends.push_back(writer("rt/uav1/phone/pose", "sim", test::kScanType));
  findings = diagnose(evidence(ends, both()));
  ASSERT_THAT(kinds(findings), ElementsAre("unwritten"));
  EXPECT_THAT(findings[0].remedy, HasSubstr("'uav1/phone/pose' is written"));
}

TEST(Diagnosis, CommandsAndViewersMayWait) {
  auto ends = sound();
  for (const char* topic : {"rt/mode", "rt/uav1/waypoints", "rt/uav1/goal_pose",
                            "rt/parameter/request", "rt/mode/ack"}) {
    ends.push_back(reader(topic, "estimator"));
  }
  Endpoint viewer = reader("rt/map", "");
  ends.push_back(viewer);
  EXPECT_THAT(kinds(diagnose(evidence(ends, both()))), ElementsAre("unknown participant"));
}

TEST(Diagnosis, WhatComponentsLackIsAProblem) {
  auto instances = both();
  instances[1].problems = {"imu0: 3 Hz instead of 1000"};
  const auto findings = diagnose(evidence(sound(), instances));
  ASSERT_THAT(kinds(findings), ElementsAre("problem"));
  EXPECT_THAT(findings[0].text, AllOf(HasSubstr("estimator"), HasSubstr("3 Hz instead of 1000")));
}

TEST(Diagnosis, TwoActiveInstancesOfOneComponent) {
  auto instances = both();
  Instance second = instance("estimator");
  second.process = "estimator.2";
  instances.push_back(second);
  auto findings = diagnose(evidence(sound(), instances));
  ASSERT_THAT(kinds(findings), ElementsAre("two active"));
  EXPECT_THAT(findings[0].text, HasSubstr("estimator.1, estimator.2"));
  instances.back().active = false;
  EXPECT_THAT(kinds(diagnose(evidence(sound(), instances))), IsEmpty()) << "one stands by";
  instances.back().active = true;
  instances.back().vehicle = "uav2";
  EXPECT_THAT(kinds(diagnose(evidence(sound(), instances))), IsEmpty()) << "another vehicle's";
}

TEST(Diagnosis, ComponentsThatFellSilentOrNeverSpoke) {
  auto instances = both();
  instances[1].heard = kNow - 500ms;
  auto findings = diagnose(evidence(sound(), instances));
  ASSERT_THAT(kinds(findings), ElementsAre("silent"));
  EXPECT_THAT(findings[0].text, HasSubstr("0.50 s ago"));
  instances.pop_back();
  findings = diagnose(evidence(sound(), instances));
  ASSERT_THAT(kinds(findings), ElementsAre("silent")) << "it announces its status and gives none";
  EXPECT_THAT(findings[0].text, HasSubstr("estimator of process estimator.1"));
}

TEST(Diagnosis, StrangersAreListedWithTheirEndsAndAreNoProblem) {
  auto ends = sound();
  ends.push_back(reader("rt/imu0", ""));
  ends.push_back(writer("rt/goal", ""));
  const auto findings = diagnose(evidence(ends, both()));
  ASSERT_THAT(kinds(findings), ElementsAre("unknown participant"));
  EXPECT_FALSE(findings[0].is_problem);
  EXPECT_THAT(findings[0].text,
              AllOf(HasSubstr("'rviz2'"), HasSubstr("it writes goal"), HasSubstr("it reads imu0")));
  EXPECT_EQ(findings_json(findings)["healthy"], true);
}

}  // namespace
}  // namespace swiftlet
