// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/qos_overrides.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "components/runtime/config/config.hpp"
#include "components/runtime/dds/endpoint_qos.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace fs = std::filesystem;
using eprosima::fastrtps::Duration_t;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class QosOverridesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = fs::temp_directory_path() / ("qos_overrides_" + std::to_string(getpid()) + ".xml");
  }
  void TearDown() override { fs::remove(file_); }

  QosOverrides load(const std::string& text, const std::string& vehicle = "") {
    std::ofstream(file_) << text;
    return QosOverrides::load(file_.string(), {{"imu0", "scan", "vehicle/status"}, vehicle});
  }
  QosOverrides profiles(const std::string& text, const std::string& vehicle = "") {
    return load("<?xml version=\"1.0\"?>\n<dds>\n<profiles>\n" + text + "\n</profiles>\n</dds>\n",
                vehicle);
  }
  /// What is wrong with it; "" where nothing is.
  std::string problem(const std::string& text) {
    try {
      load(text);
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }

  static EndpointSpec spec(const std::string& topic, const QosProfile& profile) {
    return {topic, "std_msgs::msg::dds_::Header_", profile, "tester", nullptr};
  }
  static dds::DataWriterQos writer(const QosOverrides& overrides, const std::string& topic,
                                   const QosProfile& profile) {
    return writer_qos(spec(topic, profile), {}, &overrides);
  }
  static dds::DataReaderQos reader(const QosOverrides& overrides, const std::string& topic,
                                   const QosProfile& profile) {
    return reader_qos(spec(topic, profile), {}, &overrides);
  }

  fs::path file_;
};

const char* const kDeadline =
    "<qos><deadline><period><sec>0</sec><nanosec>250000000</nanosec></period></deadline></qos>";

TEST_F(QosOverridesTest, ExactlyThePoliciesThatArePresentChange) {
  const auto overrides =
      profiles("<data_writer profile_name=\"sensor\">" + std::string(kDeadline) + "</data_writer>");
  dds::DataWriterQos expected = writer_qos(spec("rt/imu0", qos::sensor), {}, nullptr);
  EXPECT_FALSE(writer(overrides, "rt/imu0", qos::sensor) == expected);
  expected.deadline().period = Duration_t(0, 250'000'000);
  EXPECT_TRUE(writer(overrides, "rt/imu0", qos::sensor) == expected);
  // Other profiles, and readers, are as they were.
  EXPECT_TRUE(writer(overrides, "rt/x", qos::state) ==
              writer_qos(spec("rt/x", qos::state), {}, nullptr));
  EXPECT_TRUE(reader(overrides, "rt/imu0", qos::sensor) ==
              reader_qos(spec("rt/imu0", qos::sensor), {}, nullptr));
}

TEST_F(QosOverridesTest, TheTopicWinsOverTheProfileInWhateverOrder) {
  const std::string by_profile =
      "<data_reader profile_name=\"state\"><topic><historyQos><depth>7</depth></historyQos></topic>"
      "<qos><durability><kind>TRANSIENT_LOCAL</kind></durability></qos></data_reader>";
  const std::string by_topic =
      "<data_reader profile_name=\"vehicle/status\"><topic><historyQos><depth>9</depth>"
      "</historyQos></topic></data_reader>";
  for (const std::string& text : {by_profile + by_topic, by_topic + by_profile}) {
    const auto overrides = profiles(text);
    const auto qos = reader(overrides, "rt/vehicle/status", qos::state);
    EXPECT_EQ(qos.history().depth, 9);
    EXPECT_EQ(qos.durability().kind, dds::TRANSIENT_LOCAL_DURABILITY_QOS);
    EXPECT_EQ(reader(overrides, "rt/odometry", qos::state).history().depth, 7);
  }
}

TEST_F(QosOverridesTest, TopicsAreMeantWithOrWithoutTheirPrefix) {
  const std::string text =
      "<data_writer profile_name=\"NAME\">" + std::string(kDeadline) + "</data_writer>";
  const auto named = [&](const std::string& name, const std::string& vehicle) {
    return profiles(std::regex_replace(text, std::regex("NAME"), name), vehicle);
  };
  const auto is_changed = [&](const QosOverrides& overrides, const std::string& topic) {
    return writer(overrides, topic, qos::sensor).deadline().period == Duration_t(0, 250'000'000);
  };
  EXPECT_TRUE(is_changed(named("imu0", ""), "rt/imu0"));
  EXPECT_TRUE(is_changed(named("rt/imu0", ""), "rt/imu0"));
  EXPECT_TRUE(is_changed(named("imu0", "uav1"), "rt/uav1/imu0"));
  EXPECT_FALSE(is_changed(named("imu0", "uav1"), "rt/uav2/imu0"));
  EXPECT_TRUE(is_changed(named("rt/uav2/imu0", "uav1"), "rt/uav2/imu0"));
  EXPECT_TRUE(is_changed(named("rt/somebody_elses", ""), "rt/somebody_elses"));
}

TEST_F(QosOverridesTest, EveryPolicyOfTheFileArrives) {
  const auto overrides = profiles(R"(<data_writer profile_name="command">
    <historyMemoryPolicy>DYNAMIC</historyMemoryPolicy>
    <topic>
      <historyQos><kind>KEEP_ALL</kind></historyQos>
      <resourceLimitsQos><max_samples>50</max_samples><allocated_samples>5</allocated_samples>
      </resourceLimitsQos>
    </topic>
    <qos>
      <reliability><kind>BEST_EFFORT</kind></reliability>
      <lifespan><duration><sec>3</sec></duration></lifespan>
      <latencyBudget><duration><sec>4</sec></duration></latencyBudget>
      <liveliness><kind>MANUAL_BY_TOPIC</kind><lease_duration><sec>2</sec></lease_duration>
        <announcement_period><sec>1</sec></announcement_period></liveliness>
      <ownership><kind>EXCLUSIVE</kind></ownership>
      <ownershipStrength><value>12</value></ownershipStrength>
      <partition><names><name>a</name><name>b*</name></names></partition>
      <publishMode><kind>ASYNCHRONOUS</kind></publishMode>
    </qos>
    <times><heartbeatPeriod><sec>9</sec></heartbeatPeriod></times>
  </data_writer>)");
  const auto qos = writer(overrides, "rt/setpoint", qos::command);
  EXPECT_EQ(qos.endpoint().history_memory_policy,
            eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE);
  EXPECT_EQ(qos.history().kind, dds::KEEP_ALL_HISTORY_QOS);
  EXPECT_EQ(qos.history().depth, qos::command.depth) << "not in the file";
  EXPECT_EQ(qos.resource_limits().max_samples, 50);
  EXPECT_EQ(qos.resource_limits().allocated_samples, 5);
  EXPECT_EQ(qos.reliability().kind, dds::BEST_EFFORT_RELIABILITY_QOS);
  EXPECT_EQ(qos.reliability().max_blocking_time, Duration_t(0, 20'000'000)) << "not in the file";
  EXPECT_EQ(qos.lifespan().duration, Duration_t(3, 0));
  EXPECT_EQ(qos.latency_budget().duration, Duration_t(4, 0));
  EXPECT_EQ(qos.liveliness().kind, dds::MANUAL_BY_TOPIC_LIVELINESS_QOS);
  EXPECT_EQ(qos.liveliness().lease_duration, Duration_t(2, 0));
  EXPECT_EQ(qos.liveliness().announcement_period, Duration_t(1, 0));
  EXPECT_EQ(qos.ownership().kind, dds::EXCLUSIVE_OWNERSHIP_QOS);
  EXPECT_EQ(qos.ownership_strength().value, 12u);
  EXPECT_EQ(qos.publish_mode().kind, dds::ASYNCHRONOUS_PUBLISH_MODE);
  EXPECT_EQ(qos.reliable_writer_qos().times.heartbeatPeriod, Duration_t(9, 0));
  EXPECT_THAT(overrides.writer_partitions("rt/setpoint", "command"), ElementsAre("a", "b*"));
  EXPECT_THAT(overrides.reader_partitions("rt/setpoint", "command"), IsEmpty());
}

TEST_F(QosOverridesTest, TheDepthTakesItsLimitsAlong) {
  const auto overrides = profiles(
      "<data_reader profile_name=\"imu0\"><topic><historyQos><depth>400</depth></historyQos>"
      "</topic></data_reader>");
  const auto qos = reader(overrides, "rt/imu0", qos::sensor);
  EXPECT_EQ(qos.history().depth, 400);
  EXPECT_EQ(qos.resource_limits().max_samples, 400);
}

TEST_F(QosOverridesTest, AFileThatCannotBeUsedIsRefusedWithItsLine) {
  EXPECT_THAT(problem("<dds>\n<profiles>\n</dds>\n"),
              AllOf(HasSubstr(file_.string() + ":"), HasSubstr("not XML")));
  EXPECT_THAT(problem(""), HasSubstr("not XML"));
  EXPECT_THAT(problem("<!-- nothing -->"), HasSubstr(":1: there is no element"));
  EXPECT_THAT(problem("<hello/>"), HasSubstr(":1: <hello> has no meaning here"));
  const auto in_profile = [&](const std::string& text) {
    return problem("<dds>\n<profiles>\n<data_writer profile_name=\"imu0\">\n" + text +
                   "\n</data_writer>\n</profiles>\n</dds>\n");
  };
  EXPECT_EQ(in_profile(kDeadline), "");
  EXPECT_THAT(in_profile("<qos>\n<reliability>\n<kind>SOMETIMES</kind></reliability></qos>"),
              AllOf(HasSubstr(":6: "), HasSubstr("<kind>"), HasSubstr("SOMETIMES")));
  EXPECT_THAT(in_profile("<qos>\n<deadlin/></qos>"),
              AllOf(HasSubstr(":5: <deadlin>"), HasSubstr("<deadline>")));
  EXPECT_THAT(in_profile("<unicastLocatorList/>"), HasSubstr(":4: <unicastLocatorList>"));
  EXPECT_THAT(in_profile("<qos><durability>\n<kind>PERSISTENT</kind></durability></qos>"),
              AllOf(HasSubstr(":5: "), HasSubstr("durability service")));
  EXPECT_THAT(in_profile("<topic><historyQos>\n<depth>0</depth></historyQos></topic>"),
              AllOf(HasSubstr(":5: "), HasSubstr("at least 1")));
  EXPECT_THAT(in_profile(std::string(kDeadline) + "\n" + kDeadline), HasSubstr("second time"));
}

TEST_F(QosOverridesTest, AnUnknownProfileIsRefusedWithTheNearestName) {
  const auto named = [&](const std::string& attributes) {
    return problem("<dds><profiles>\n<data_writer " + attributes + "/>\n</profiles></dds>");
  };
  EXPECT_THAT(named("profile_name=\"sensro\""),
              AllOf(HasSubstr(":2: 'sensro'"), HasSubstr("did you mean 'sensor'?")));
  EXPECT_THAT(named("profile_name=\"vehicle/state\""), HasSubstr("did you mean 'vehicle/status'?"));
  EXPECT_THAT(named(""), HasSubstr("no profile_name"));
  EXPECT_THAT(named("profile_name=\"imu0\" is_default_profile=\"true\""),
              HasSubstr("is_default_profile"));
  EXPECT_THAT(problem("<dds><profiles><data_writer profile_name=\"imu0\"/>\n"
                      "<data_writer profile_name=\"rt/imu0\"/></profiles></dds>"),
              HasSubstr(":2: there is a second"));
  EXPECT_THAT(problem("<dds><profiles>\n<participant profile_name=\"x\"/></profiles></dds>"),
              HasSubstr(":2: <participant> has no meaning here"));
  EXPECT_THROW(QosOverrides::load("/nowhere/at/all.xml", {}), ConfigError);
}

/// topic::names is a second list beside the constants: this compares the two.
TEST(TopicNames, AreThoseOfAllTopics) {
  std::string source;
  for (const char* file : {"/components/topics.hpp", "/components/runtime/topic.hpp"}) {
    std::ifstream stream(std::string(SWIFTLET_SOURCE_DIR) + file);
    source.append(std::istreambuf_iterator<char>(stream), {});
  }
  const std::regex constant("inline constexpr Topic<[^>]*> [a-z0-9_]+\\{\"([^\"]+)\"");
  std::set<std::string> declared;
  for (std::sregex_iterator match(source.begin(), source.end(), constant), end; match != end;
       ++match) {
    declared.insert((*match)[1]);
  }
  ASSERT_GT(declared.size(), 20u);
  EXPECT_EQ(declared, std::set<std::string>(std::begin(topic::names), std::end(topic::names)));
}

}  // namespace
}  // namespace swiftlet
