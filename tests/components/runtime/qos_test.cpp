// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/qos.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/runtime/dds/endpoint_qos.hpp"
#include "components/runtime/topic.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// Two values of one policy; a reader that asks for the stronger refuses a writer of the weaker.
struct Policy {
  const char* name;
  void (*weaken)(QosProfile&);
  void (*strengthen)(QosProfile&);
};

const Policy kPolicies[] = {
    {"reliability", [](QosProfile& q) { q.reliable = false; },
     [](QosProfile& q) { q.reliable = true; }},
    {"durability", [](QosProfile& q) { q.transient_local = false; },
     [](QosProfile& q) { q.transient_local = true; }},
    {"deadline", [](QosProfile& q) { q.deadline = 2s; }, [](QosProfile& q) { q.deadline = 1s; }},
    {"liveliness", [](QosProfile& q) { q.liveliness = Liveliness::kByParticipant; },
     [](QosProfile& q) { q.liveliness = Liveliness::kByTopic; }},
    {"liveliness lease", [](QosProfile&) {}, [](QosProfile& q) { q.lease = 5s; }},
    {"latency budget", [](QosProfile& q) { q.latency_budget = 5ms; }, [](QosProfile&) {}},
    {"destination order", [](QosProfile&) {}, [](QosProfile& q) { q.by_source_time = true; }},
};

TEST(QosConflict, AReaderMayAskForAsMuchAsIsOfferedAndNoMore) {
  for (const Policy& policy : kPolicies) {
    QosProfile weak = qos::sensor;
    QosProfile strong = qos::sensor;
    policy.weaken(weak);
    policy.strengthen(strong);
    EXPECT_EQ(qos_conflict(weak, weak), "") << policy.name;
    EXPECT_EQ(qos_conflict(strong, strong), "") << policy.name;
    EXPECT_EQ(qos_conflict(strong, weak), "") << policy.name;
    EXPECT_THAT(qos_conflict(weak, strong), HasSubstr(std::string(policy.name) + ": offered "));
  }
}

TEST(QosConflict, OwnershipMustBeTheSame) {
  QosProfile exclusive = qos::state;
  exclusive.exclusive = true;
  EXPECT_EQ(qos_conflict(exclusive, exclusive), "");
  EXPECT_EQ(qos_conflict(exclusive, qos::state), "ownership: offered exclusive, requested shared");
  EXPECT_EQ(qos_conflict(qos::state, exclusive), "ownership: offered shared, requested exclusive");
}

TEST(QosConflict, NamesBothValues) {
  QosProfile slow = qos::sensor;
  slow.deadline = 1500ms;
  QosProfile fast = qos::sensor;
  fast.deadline = 20ms;
  EXPECT_EQ(qos_conflict(slow, fast), "deadline: offered 1.5 s, requested 0.02 s");
  EXPECT_EQ(qos_conflict(qos::sensor, fast), "deadline: offered unlimited, requested 0.02 s");
}

/// What ROS 2 Humble's rmw offers and requests where nobody says otherwise (rmw/qos_profiles.h).
constexpr QosProfile kRmwDefault{"rmw default", true, false, 10, false};
constexpr QosProfile kRmwSensorData{"rmw sensor data", false, false, 5, false};
constexpr QosProfile kRmwTransientLocal{"rmw latched", true, true, 1, false};

TEST(QosConflict, OurProfilesTalkToRos2sDefaults) {
  for (const QosProfile* ours : qos::profiles) {
    const bool keeps_last = ours->transient_local;  // as every latched topic of ROS 2
    EXPECT_EQ(qos_conflict(keeps_last ? kRmwTransientLocal : kRmwDefault, *ours), "") << ours->name;
    EXPECT_EQ(qos_conflict(*ours, kRmwSensorData), "") << ours->name;
    // What is best effort here is best effort there: a reliable reader gets no sensor data.
    const bool same = ours->reliable == kRmwDefault.reliable;
    EXPECT_EQ(qos_conflict(*ours, kRmwDefault).empty(), same) << ours->name;
    EXPECT_EQ(qos_conflict(kRmwSensorData, *ours).empty(), !ours->reliable) << ours->name;
  }
}

EndpointSpec spec(const QosProfile& profile) {
  return {"rt/x", "std_msgs::msg::dds_::Header_", profile, "tester", nullptr};
}

void expect_equal(const QosProfile& a, const QosProfile& b) {
  EXPECT_STREQ(a.name, b.name);
  EXPECT_EQ(a.reliable, b.reliable);
  EXPECT_EQ(a.transient_local, b.transient_local);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.deadline, b.deadline);
  EXPECT_EQ(a.lifespan, b.lifespan);
  EXPECT_EQ(a.latency_budget, b.latency_budget);
  EXPECT_EQ(a.liveliness, b.liveliness);
  EXPECT_EQ(a.lease, b.lease);
  EXPECT_EQ(a.exclusive, b.exclusive);
}

TEST(EndpointQos, AProfileSurvivesTheWayToDdsAndBack) {
  QosProfile unusual = qos::command;
  unusual.deadline = 20ms;
  unusual.lifespan = 1500ms;
  unusual.latency_budget = 3ms;
  unusual.liveliness = Liveliness::kByTopic;
  unusual.lease = 7s;
  unusual.exclusive = true;
  for (const QosProfile& profile :
       {qos::sensor, qos::state, qos::command, qos::map, qos::event, qos::bulk, unusual}) {
    expect_equal(profile_of(writer_qos(spec(profile), {}, nullptr), profile), profile);
    expect_equal(profile_of(reader_qos(spec(profile), {}, nullptr), profile), profile);
  }
}

TEST(EndpointQos, ReadersOfFastPeriodicTopicsWaitForNoLostSample) {
  EXPECT_FALSE(requested_qos(qos::command, 10ms).reliable);
  EXPECT_FALSE(requested_qos(qos::state, 4ms).reliable);
  EXPECT_TRUE(requested_qos(qos::state, 100ms).reliable);
  EXPECT_TRUE(requested_qos(qos::command, 0ms).reliable) << "what is said once must arrive";
  EXPECT_FALSE(requested_qos(qos::sensor, 100ms).reliable);
  EXPECT_EQ(qos_conflict(qos::command, requested_qos(qos::command, 10ms)), "");
}

TEST(EndpointQos, SlowPeriodicTopicsOfferADeadlineAndNobodyAsksForOne) {
  const auto offered = [](Duration period, bool isolated) {
    const QosProfile qos = offered_qos(qos::sensor, period);
    return profile_of(writer_qos(spec(qos), {isolated, false}, nullptr), qos).deadline;
  };
  EXPECT_EQ(offered(100ms, false), 300ms);
  EXPECT_EQ(offered(4ms, false), kUnlimited);
  EXPECT_EQ(offered(0ms, false), kUnlimited);
  EXPECT_EQ(offered(100ms, true), kUnlimited) << "wall time means nothing there";
  for (const QosProfile* profile : qos::profiles) {
    EXPECT_EQ(reader_qos(spec(*profile), {}, nullptr).deadline().period,
              eprosima::fastrtps::c_TimeInfinite);
  }
}

TEST(EndpointQos, AnAnnouncementIsReadBackAndNothingElseIsBelieved) {
  const auto read = [](const std::string& text) {
    return read_announcement({text.begin(), text.end()});
  };
  EXPECT_EQ(read(announcement("flight_controller", 32)).component, "flight_controller");
  EXPECT_EQ(read(announcement("flight_controller", 32)).depth, 32);
  EXPECT_EQ(read("").component, "");
  EXPECT_EQ(read("subcomponent=x;").component, "");
  for (const char* bad : {"", "depth=;", "depth=-1;", "depth=99999999999999;", "depth=1x;"}) {
    EXPECT_EQ(read(bad).depth, 0) << bad;
  }
}

}  // namespace
}  // namespace swiftlet
