// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "all_messages.hpp"
#include "components/bag/mcap/writer.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/reflection/idl_schema.hpp"
#include "tests/components/bag/node_decoder.hpp"
#include "tests/components/bag/temporary_folder.hpp"

/// Recordings of ours, decoded by the libraries that Foxglove uses.
namespace swiftlet {
namespace {

using nlohmann::json;

/// A file with one message on each topic that is added.
class Recorder {
 public:
  Recorder(const std::filesystem::path& path, mcap::Compression compression)
      : writer_(mcap::Writer::open(path, params(compression)).value()) {}

  template <class T>
  void add(const std::string& topic, const T& message) {
    const std::string& type = message_type<T>().name();
    const auto text = idl_schema(type);
    ASSERT_TRUE(text.ok()) << text.error().reason;
    const auto schema = writer_.add_schema(type, "ros2idl", std::string_view(*text));
    const auto channel = writer_.add_channel(topic, "cdr", *schema, {{"offered_qos_profiles", ""}});
    const Cdr cdr = to_cdr(message);
    ++count_;
    ASSERT_TRUE(writer_
                    .write(mcap::Message{*channel, count_, 1'000'000'000'000'000'000U + count_,
                                         count_, cdr})
                    .ok());
  }
  mcap::Writer& writer() { return writer_; }

 private:
  static mcap::WriterParams params(mcap::Compression compression) {
    mcap::WriterParams params;
    params.profile = "ros2";
    params.compression = compression;
    params.chunk_size = 600;  // several chunks
    return params;
  }

  mcap::Writer writer_;
  std::uint32_t count_ = 0;
};

template <class Header>
json stamp(Header& header, int sec, unsigned nanosec, const std::string& frame) {
  header.stamp().sec(sec);
  header.stamp().nanosec(nanosec);
  header.frame_id(frame);
  return {{"stamp", {{"sec", sec}, {"nsec", nanosec}}}, {"frame_id", frame}};
}

json vector(double x, double y, double z) {
  return {{"x", x}, {"y", y}, {"z", z}};
}

class NodeDecoders : public testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    decoder_ = decoder(reason);
    if (decoder_.empty()) GTEST_SKIP() << reason;
  }
  TemporaryFolder folder_;
  std::filesystem::path decoder_;
};

TEST_F(NodeDecoders, ReadTheValuesThatWereWritten) {
  for (const auto compression :
       {mcap::Compression::kNone, mcap::Compression::kLz4, mcap::Compression::kZstd}) {
    std::filesystem::remove(folder_ / "f.mcap");
    Recorder recorder(folder_ / "f.mcap", compression);
    std::map<std::string, json> expected;

    sensor_msgs::msg::Imu imu;
    json header = stamp(imu.header(), 12, 345'678'901, "base_link");
    imu.orientation().w(0.5);
    imu.orientation().x(-0.5);
    imu.angular_velocity().y(0.125);
    imu.linear_acceleration().z(9.80665);
    imu.orientation_covariance()[8] = -1.0;
    json imu_value = {{"header", header},
                      {"orientation", {{"x", -0.5}, {"y", 0}, {"z", 0}, {"w", 0.5}}},
                      {"angular_velocity", vector(0, 0.125, 0)},
                      {"linear_acceleration", vector(0, 0, 9.80665)}};
    for (const char* name : {"orientation_covariance", "angular_velocity_covariance",
                             "linear_acceleration_covariance"}) {
      imu_value[name] = std::vector<double>(9, 0.0);
    }
    imu_value["orientation_covariance"][8] = -1.0;
    recorder.add("imu0", imu);
    expected["imu0"] = imu_value;

    sensor_msgs::msg::LaserScan scan;
    header = stamp(scan.header(), -1, 0, "");
    scan.angle_min(-1.5F);
    scan.range_max(12.0F);
    scan.ranges({1.25F, std::numeric_limits<float>::infinity(),
                 std::numeric_limits<float>::quiet_NaN(), 0.5F});
    recorder.add("scan", scan);
    expected["scan"] = {{"header", header},
                        {"angle_min", -1.5},
                        {"angle_max", 0},
                        {"angle_increment", 0},
                        {"time_increment", 0},
                        {"scan_time", 0},
                        {"range_min", 0},
                        {"range_max", 12},
                        {"ranges", {1.25, "Infinity", "NaN", 0.5}},
                        {"intensities", json::array()}};

    nav_msgs::msg::OccupancyGrid grid;
    header = stamp(grid.header(), 3, 4, "map");
    grid.info().resolution(0.0625F);
    grid.info().width(3);
    grid.info().height(2);
    grid.info().origin().position().x(-7.5);
    grid.info().origin().orientation().w(1.0);
    grid.data({0, 100, -1, 50, 0, -1});
    recorder.add("map", grid);
    expected["map"] = {{"header", header},
                       {"info",
                        {{"map_load_time", {{"sec", 0}, {"nsec", 0}}},
                         {"resolution", 0.0625},
                         {"width", 3},
                         {"height", 2},
                         {"origin",
                          {{"position", vector(-7.5, 0, 0)},
                           {"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}}}}}},
                       {"data", {0, 100, -1, 50, 0, -1}}};

    tf2_msgs::msg::TFMessage tf;
    geometry_msgs::msg::TransformStamped transform;
    json transforms = json::array();
    for (int i = 0; i < 3; ++i) {
      header = stamp(transform.header(), i, 7, std::string(static_cast<std::size_t>(i), 'x'));
      transform.child_frame_id("child" + std::to_string(i));
      transform.transform().translation().z(i + 0.5);
      tf.transforms().push_back(transform);
      const json rotation = {{"x", transform.transform().rotation().x()},
                             {"y", transform.transform().rotation().y()},
                             {"z", transform.transform().rotation().z()},
                             {"w", transform.transform().rotation().w()}};
      transforms.push_back(
          {{"header", header},
           {"child_frame_id", "child" + std::to_string(i)},
           {"transform", {{"translation", vector(0, 0, i + 0.5)}, {"rotation", rotation}}}});
    }
    recorder.add("tf", tf);
    expected["tf"] = {{"transforms", transforms}};

    diagnostic_msgs::msg::DiagnosticArray diagnostics;
    header = stamp(diagnostics.header(), 5, 6, "");
    diagnostic_msgs::msg::DiagnosticStatus status;
    status.level(2);
    status.name("battery");
    status.message("low: 10,5 V \xE2\x9A\xA0");
    diagnostic_msgs::msg::KeyValue pair;
    pair.key("voltage");
    pair.value("10.5");
    status.values({pair});
    diagnostics.status({status});
    recorder.add("diagnostics", diagnostics);
    expected["diagnostics"] = {{"header", header},
                               {"status",
                                {{{"level", 2},
                                  {"name", "battery"},
                                  {"message", "low: 10,5 V \xE2\x9A\xA0"},
                                  {"hardware_id", ""},
                                  {"values", {{{"key", "voltage"}, {"value", "10.5"}}}}}}}};

    swiftlet_msgs::msg::MotorCommand motors;
    motors.armed(true);
    motors.thrust({1.5, 2.5, 3.5, 4.5});
    recorder.add("motors", motors);
    expected["motors"] = {
        {"stamp", {{"sec", 0}, {"nsec", 0}}}, {"armed", true}, {"thrust", {1.5, 2.5, 3.5, 4.5}}};

    ASSERT_TRUE(
        recorder.writer().write(mcap::Attachment{1, 2, "a.txt", "text/plain", {'h', 'i'}}).ok());
    ASSERT_TRUE(recorder.writer().write(mcap::Metadata{"run", {{"seed", "5"}}}).ok());
    ASSERT_TRUE(recorder.writer().close().ok());

    const json result = decoded(decoder_, folder_ / "f.mcap");
    ASSERT_TRUE(result.is_object());
    EXPECT_EQ(result["profile"], "ros2");
    EXPECT_EQ(result["statistics"]["messages"], expected.size());
    EXPECT_EQ(result["messages_from_the_front"], expected.size());
    EXPECT_GT(result["statistics"]["chunks"], 2);
    const auto& compressions = result["compressions"];
    EXPECT_NE(std::find(compressions.begin(), compressions.end(), name_of(compression)),
              compressions.end());
    EXPECT_EQ(result["attachments"], json::array({{{"name", "a.txt"}, {"data", "hi"}}}));
    EXPECT_EQ(result["metadata"][0]["metadata"]["seed"], "5");
    std::uint32_t sequence = 0;
    ASSERT_EQ(result["messages"].size(), expected.size());
    for (const json& message : result["messages"]) {
      EXPECT_EQ(message["sequence"], ++sequence);
      EXPECT_EQ(message["log_time"], std::to_string(1'000'000'000'000'000'000U + sequence));
      EXPECT_EQ(message["value"], expected[message["topic"]]) << message["topic"];
    }
    for (const json& channel : result["channels"]) {
      EXPECT_EQ(channel["message_encoding"], "cdr");
      EXPECT_EQ(channel["schema_encoding"], "ros2idl");
    }
  }
}

TEST_F(NodeDecoders, KnowEveryTypeThatWeHave) {
  Recorder recorder(folder_ / "f.mcap", mcap::Compression::kZstd);
#define SWIFTLET_MESSAGE(package, Name) recorder.add(#package "/msg/" #Name, package::msg::Name());
#include "all_messages.inc"
#undef SWIFTLET_MESSAGE
  ASSERT_TRUE(recorder.writer().close().ok());
  const json result = decoded(decoder_, folder_ / "f.mcap");
  ASSERT_TRUE(result.is_object());
  EXPECT_EQ(result["messages"].size(), message_types().size());
  for (const json& message : result["messages"]) {
    EXPECT_EQ(message["type"], message["topic"]);
    EXPECT_FALSE(message["value"].empty()) << message["type"];
  }
}

}  // namespace
}  // namespace swiftlet
