// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Seen by ROS 2, and led by it: another DDS with the names and the quality of service of a ROS 2
// node (tests/cyclone).
#include <csignal>
#include <map>
#include <set>
#include <thread>

#include "components/frames.hpp"
#include "components/runtime/host.hpp"
#include "components/runtime/reflection/cdr_decoder.hpp"
#include "components/runtime/reflection/value_text.hpp"
#include "components/topics.hpp"
#include "tests/system/live_vehicle.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::Contains;

class SeenByRos2 : public LiveVehicleTest {
 protected:
  /// A node that prints what it hears on `topics`; "-" is no vehicle.
  Process ros_reader(const std::string& vehicle, const Arguments& topics) {
    Arguments command{SWIFTLET_ROS_PEER, "listen", vehicle};
    command.insert(command.end(), topics.begin(), topics.end());
    return start_command(command);
  }
  /// Sends a goal as RViz does; the GUIDs of the readers that have it.
  std::set<std::string> ros_goal(const Arguments& arguments) {
    Arguments command{SWIFTLET_ROS_PEER, "goal", "-"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    Process process = start_command(command);
    const auto finished = process.wait(Seconds(30.0) * kSlowdown);
    if (!finished || finished->exit_code != 0) {
      ADD_FAILURE() << "the goal was not sent: " << process.err();
      return {};
    }
    return json::parse(finished->out).get<std::set<std::string>>();
  }
  /// Components in two processes that stand on the ground and measure.
  void start_standing(const std::string& vehicle = "") {
    Arguments sim{"run", "sim", "--scenario", office()};
    Arguments estimator{"run", "estimator"};
    for (Arguments* host : {&sim, &estimator}) {
      if (!vehicle.empty()) host->insert(host->end(), {"--vehicle", vehicle});
      processes_.push_back(start(*host));
    }
  }
};

/// The lines of JSON that a process has written whole.
std::vector<json> lines_of(const std::string& text) {
  std::vector<json> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    lines.push_back(json::parse(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return lines;
}

/// Lines of one topic.
std::vector<json> heard(const Process& reader, const std::string& topic) {
  std::vector<json> lines;
  for (json& line : lines_of(reader.out())) {
    if (line["topic"] == topic) lines.push_back(std::move(line));
  }
  return lines;
}

/// How often `part` stands in what was written so far: cheaper than to read it.
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

std::string name_of(const json& stamp) {
  return stamp["sec"].dump() + "." + stamp["nanosec"].dump();
}

/// How many of our own reader's messages the other one has, too; all must be the same in all
/// fields.
std::size_t count_common(const std::vector<json>& theirs, const std::vector<json>& ours) {
  std::map<std::string, json> by_stamp;
  for (const json& line : theirs) {
    const json& message = line["message"];
    by_stamp[name_of(message["header"]["stamp"])] = message;
  }
  std::size_t common = 0;
  for (const json& message : ours) {
    const auto found = by_stamp.find(name_of(message["header"]["stamp"]));
    if (found == by_stamp.end()) continue;
    ++common;
    EXPECT_EQ(found->second, message);
    if (testing::Test::HasFailure()) break;  // one is enough to read
  }
  return common;
}

TEST_F(SeenByRos2, ACycloneReaderGetsTheValuesThatOurOwnReaderGets) {
  start_standing();
  Process theirs = ros_reader("-", {"odometry", "scan"});
  ASSERT_TRUE(becomes_true(Seconds(30.0), [&] {
    const std::string seen = theirs.out();
    return count(seen, R"("topic":"scan")") > 0 && count(seen, R"("topic":"odometry")") > 0;
  })) << theirs.err();
  Process odometry = start({"topic", "echo", "--json", "odometry"});
  Process scan = start({"topic", "echo", "--json", "scan"});
  constexpr std::size_t kScans = 20;
  constexpr std::size_t kOdometry = 300;
  ASSERT_TRUE(becomes_true(Seconds(40.0),
                           [&] {
                             const std::string seen = theirs.out();
                             return count(seen, R"("topic":"scan")") >= kScans &&
                                    count(seen, R"("topic":"odometry")") >= kOdometry &&
                                    count(scan.out(), "\n") >= kScans &&
                                    count(odometry.out(), "\n") >= kOdometry;
                           }))
      << theirs.err() << scan.err() << odometry.err();
  expect_end(theirs, SIGTERM, 0);
  expect_end(odometry, SIGINT, 0);
  expect_end(scan, SIGINT, 0);

  const auto poses = lines_of(odometry.out());
  EXPECT_GE(count_common(heard(theirs, "odometry"), poses), kOdometry / 2);
  const auto scans = lines_of(scan.out());
  EXPECT_GE(count_common(heard(theirs, "scan"), scans), kScans / 2);
  // What was compared is something.
  EXPECT_NEAR(poses.back()["pose"]["pose"]["position"]["x"], 0.9, 0.3);
  EXPECT_GT(poses.back()["pose"]["covariance"][0], 0.0);
  EXPECT_EQ(scans.back()["ranges"].size(), 1000u);
  stop_vehicle();
}

/// A GUID as gids of Humble have it: 16 bytes, then zeros.
json gid_of(const std::string& guid) {
  json data = json::array();
  for (std::size_t i = 0; i < 24; ++i) {
    data.push_back(i < 16 ? std::stoi(guid.substr(2 * i, 2), nullptr, 16) : 0);
  }
  return {{"data", data}};
}

/// What was announced last of the node with that name: its participant's gid beside it.
json node_of(const Process& reader, const std::string& name) {
  json found;
  for (const json& line : heard(reader, "ros_discovery_info")) {
    for (const json& node : line["message"]["node_entities_info_seq"]) {
      if (node["node_name"] != name) continue;
      found = node;
      found["participant"] = line["message"]["gid"];
    }
  }
  return found;
}

TEST_F(SeenByRos2, NodesAreAnnouncedWithTheGidsOfTheirEndpoints) {
  start_standing("uav1");
  Process reader = ros_reader("uav1", {"odometry", "scan", "ros_discovery_info"});
  const auto writer_of = [&](const std::string& topic) {
    const auto lines = heard(reader, topic);
    return lines.empty() ? std::string(32, '0') : lines.back()["writer"].get<std::string>();
  };
  const auto announces = [&](const std::string& node, const std::string& topic) {
    const json info = node_of(reader, node);
    if (info.is_null()) return false;
    const std::vector<json> writers = info["writer_gid_seq"];
    return testing::Value(writers, Contains(gid_of(writer_of(topic))));
  };
  ASSERT_TRUE(
      becomes_true(Seconds(30.0),
                   [&] { return announces("estimator", "odometry") && announces("sim", "scan"); }))
      << reader.err() << node_of(reader, "estimator").dump() << writer_of("odometry");
  EXPECT_FALSE(announces("estimator", "scan")) << "that is the simulator's";
  EXPECT_FALSE(announces("sim", "odometry"));
  for (const auto& [node, topic] : {std::pair{"estimator", "odometry"}, {"sim", "scan"}}) {
    const json info = node_of(reader, node);
    EXPECT_EQ(info["node_namespace"], "/uav1");
    // The participant has the prefix of its writers' GUIDs, and the entity id that RTPS gives it.
    EXPECT_EQ(info["participant"], gid_of(writer_of(topic).substr(0, 24) + "000001c1"));
  }
  expect_end(reader, SIGTERM, 0);
  stop_vehicle();
}

TEST_F(SeenByRos2, WhoComesLateKnowsWhereEverySensorSits) {
  start_standing();
  Process first = ros_reader("-", {"scan"});
  ASSERT_TRUE(becomes_true(Seconds(30.0), [&] { return !heard(first, "scan").empty(); }));
  Process late = ros_reader("-", {"tf", "tf_static"});
  ASSERT_TRUE(becomes_true(Seconds(30.0), [&] {
    return !heard(late, "tf").empty() && !heard(late, "tf_static").empty();
  })) << late.err();

  const json moving = heard(late, "tf").back()["message"]["transforms"];
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_EQ(moving[0]["header"]["frame_id"], "map");
  EXPECT_EQ(moving[0]["child_frame_id"], "base_link");
  std::map<std::string, json> mounts;
  const json still = heard(late, "tf_static").back()["message"]["transforms"];
  for (const json& transform : still) {
    EXPECT_EQ(transform["header"]["frame_id"], "base_link");
    mounts[transform["child_frame_id"]] = transform["transform"];
  }
  const std::string laser = heard(first, "scan").back()["message"]["header"]["frame_id"];
  ASSERT_EQ(mounts.count(laser), 1u);
  EXPECT_EQ(mounts[laser]["translation"], json({{"x", 0.0}, {"y", 0.0}, {"z", 0.08}}));
  // Every other frame that a sensor's message names is there, too.
  for (const char* topic : {"imu0", "imu1", "imu2", "range/down"}) {
    const Finished frame = run({"topic", "echo", topic, "--once", "--field", "header.frame_id"});
    EXPECT_EQ(mounts.count(frame.out.substr(0, frame.out.find('\n'))), 1u) << topic << frame.out;
  }
  // sensor_msgs/Range is along x: here straight down.
  const json& q = mounts["range_down"]["rotation"];
  const Eigen::Quaterniond attitude(q["w"], q["x"], q["y"], q["z"]);
  EXPECT_LT((attitude * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  expect_end(first, SIGTERM, 0);
  expect_end(late, SIGTERM, 0);
  stop_vehicle();
}

/// Sends one of each type that viewers draw, again and again.
struct Talker : Component {
  explicit Talker(const ComponentContext& context) : Component(context) {
    const Time stamp(std::chrono::milliseconds(1234567));
    auto frame = std::make_unique<swiftlet_frames::msg::Image640k>();
    EXPECT_TRUE(describe(stamp, {"camera", "rgb8", 320, 240}, *frame).ok());
    for (std::size_t i = 0; i < 320 * 240 * 3; ++i) {
      frame->data()[i] = static_cast<std::uint8_t>(i % 251);
    }
    auto cloud = std::make_unique<swiftlet_frames::msg::Cloud256k>();
    EXPECT_TRUE(describe(stamp, "camera", 1000, *cloud).ok());
    for (std::size_t i = 0; i < 4000; ++i) cloud->points()[i] = 0.1f * static_cast<float>(i);
    nav_msgs::msg::OccupancyGrid map;
    map.header(make_header(stamp, frame::kMap));
    map.info().resolution(0.05f);
    map.info().width(7);
    map.info().height(11);
    map.info().origin(to_pose({-1.0, 2.0, 0.0}, Eigen::Quaterniond::Identity()));
    for (int i = 0; i < 77; ++i) map.data().push_back(static_cast<std::int8_t>(i - 1));
    nav_msgs::msg::Path path;
    path.header(make_header(stamp, frame::kMap));
    for (int i = 0; i < 3; ++i) {
      geometry_msgs::msg::PoseStamped pose;
      pose.header(make_header(stamp + i * std::chrono::seconds(1), frame::kMap));
      pose.pose(to_pose({0.1 * i, 2.0, 1.0}, Eigen::Quaterniond(0.6, 0.0, 0.0, 0.8)));
      path.poses().push_back(pose);
    }
    send(Topic<sensor_msgs::msg::Image>{"image", qos::bulk}, to_image(*frame).value());
    send(Topic<sensor_msgs::msg::PointCloud2>{"points", qos::bulk}, to_point_cloud(*cloud).value());
    send(topic::map, map);
    send(topic::path, path);
  }
  template <class T>
  void send(const Topic<T>& topic, const T& message) {
    const auto value =
        decode(*TypeLibrary::built_in().find(message_type<T>().name()), to_cdr(message));
    sent[topic.name] = json::parse(to_json(value.value()).dump());
    every(std::chrono::milliseconds(200),
          [publisher = advertise(topic), message](Time) mutable { publisher.publish(message); });
  }
  std::map<std::string, json> sent;
};

TEST_F(SeenByRos2, ImagesCloudsMapsAndPathsHaveTheirShape) {
  HostOptions options;
  options.participant.domain = domain();
  Host host(options);
  const Talker& talker = host.emplace<Talker>("talker");
  std::thread runner([&host] { host.run(); });
  Process reader = ros_reader("-", {"image", "points", "map", "path"});
  const bool all_came = becomes_true(Seconds(30.0), [&] {
    for (const auto& [topic, message] : talker.sent) {
      if (heard(reader, topic).empty()) return false;
    }
    return true;
  });
  host.executor().stop(0);
  runner.join();
  EXPECT_TRUE(all_came) << reader.err();
  for (const auto& [topic, message] : talker.sent) {
    const auto lines = heard(reader, topic);
    ASSERT_FALSE(lines.empty()) << topic;
    EXPECT_TRUE(lines.back()["message"] == message) << topic;
  }
  expect_end(reader, SIGTERM, 0);
}

TEST_F(SeenByRos2, AGoalFromRos2IsFlown) {
  if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
  start_vehicle(office());
  Process reader = ros_reader("-", {"ros_discovery_info"});
  ASSERT_TRUE(becomes_ready());
  ros_goal({"map", "2.2", "4.4", "0", "1.0"});
  ASSERT_TRUE(status_becomes("told why not", Seconds(10.0), [](const json& status) {
    return status["reason"].get<std::string>().find("on the ground") != std::string::npos;
  }));

  command({"arm"});
  command({"takeoff", "1.2"});
  ends_in("Takeoff", "Hover", Seconds(20.0));
  ros_goal({"odom", "2.2", "4.4", "0", "1.0"});
  ASSERT_TRUE(status_becomes("told why not", Seconds(10.0), [](const json& status) {
    return status["reason"].get<std::string>().find("frame 'odom'") != std::string::npos;
  }));
  EXPECT_EQ(status()["mode"], "Hover");
  const double height = status()["height_m"];

  const std::set<std::string> readers = ros_goal({"map", "2.2", "4.4", "0", "1.0"});
  ASSERT_EQ(readers.size(), 1u);
  EXPECT_THAT(std::vector<json>(node_of(reader, "commander")["reader_gid_seq"]),
              Contains(gid_of(*readers.begin())));
  ASSERT_TRUE(status_becomes("on its way", Seconds(5.0), [](const json& status) {
    return status["mode"] == "Indoor Navigation";
  }));
  ends_in("Indoor Navigation", "Hover", Seconds(40.0));
  const json now = status();
  EXPECT_EQ(now["mission"]["done"], true) << now.dump(2);
  EXPECT_LT(distance(now, 2.2, 4.4), 0.3);
  EXPECT_NEAR(now["height_m"].get<double>(), height, 0.15);
  EXPECT_NEAR(now["yaw_rad"].get<double>(), 1.0, 0.15);
  expect_end(reader, SIGTERM, 0);
  stop_vehicle();
}

}  // namespace
}  // namespace swiftlet::test
