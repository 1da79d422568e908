// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Recording a vehicle in other processes, and playing it to others again.
#include <algorithm>
#include <csignal>
#include <utility>

#include "components/runtime/stamp.hpp"
#include "nav_msgs.h"
#include "tests/system/live_vehicle.hpp"
#include "tests/system/recorded.hpp"

namespace swiftlet::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using Messages = std::vector<mcap::Bytes>;

class LiveRecording : public LiveVehicleTest {
 protected:
  Process record(const std::string& file) { return start({"bag", "record", "-o", path(file)}); }

  /// Waits until a recording has grown to `bytes`.
  bool grows_to(const std::string& file, std::uintmax_t bytes) {
    return becomes_true(Seconds(30.0), [&] {
      std::error_code not_there_yet;
      const auto size = std::filesystem::file_size(path(file), not_there_yet);
      return !not_there_yet && size > bytes;
    });
  }

  void expect_sound(const std::string& file) {
    const Finished verified = run({"bag", "verify", path(file)});
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_THAT(verified.out, HasSubstr("sound"));
  }

  static std::vector<std::string> topics_of(const json& info) {
    std::vector<std::string> topics;
    for (const json& topic : info["topics"]) {
      if (topic["messages"] > 0) topics.push_back(topic["topic"]);
    }
    return topics;
  }
};

/// Whether `part` can be had from `whole` by leaving messages out.
bool is_in_order_of(const Messages& part, const Messages& whole) {
  auto at = whole.begin();
  for (const mcap::Bytes& message : part) {
    at = std::find(at, whole.end(), message);
    if (at == whole.end()) return false;
    ++at;
  }
  return true;
}

TEST_F(LiveRecording, HoldsWhatOtherProcessesSaidAndPlaysItAgain) {
  start_vehicle(hop());
  Process recorder = record("live.mcap");
  ASSERT_TRUE(becomes_ready());
  ASSERT_TRUE(grows_to("live.mcap", 500'000)) << recorder.err();
  expect_end(recorder, SIGINT, 0);
  stop_vehicle();

  expect_sound("live.mcap");
  const json info = json::parse(run({"bag", "info", "--json", path("live.mcap")}).out);
  EXPECT_EQ(info["finished"], true);
  for (const char* topic : {"imu0", "imu1", "imu2", "scan", "phone/pose", "range/down", "battery",
                            "odometry", "map", "setpoint", "motors", "vehicle/status", "clock"}) {
    EXPECT_THAT(topics_of(info), Contains(topic));
  }

  // The vehicle is gone: all that is heard now comes from the recording.
  Process second = record("again.mcap");
  ASSERT_TRUE(becomes_true(kStartLimit, [&] {
    return second.out().find("recording to") != std::string::npos;
  })) << second.err();
  // The delay gives the recorder time to find the topics on a machine that is busy.
  const Finished played = run({"bag", "play", path("live.mcap"), "--delay", "3"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  expect_end(second, SIGINT, 0);
  expect_sound("again.mcap");
  const auto original = read_topics(path("live.mcap"));
  const auto again = read_topics(path("again.mcap"));
  for (const auto& [topic, messages] : original) {
    ASSERT_EQ(again.count(topic), 1U) << topic;
    EXPECT_TRUE(is_in_order_of(again.at(topic), messages)) << topic;
    EXPECT_GT(again.at(topic).size(), messages.size() / 2) << topic;
  }
  for (const char* reliable : {"odometry", "setpoint", "motors", "vehicle/status", "battery"}) {
    EXPECT_TRUE(again.at(reliable) == original.at(reliable))
        << reliable << ": " << again.at(reliable).size() << " of " << original.at(reliable).size();
  }
}

TEST_F(LiveRecording, OfOneTopicHoldsThatTopicOnly) {
  Process sim = start({"run", "sim", "--scenario", hop()});
  Process recorder = start({"bag", "record", "-o", path("scan.mcap"), "scan"});
  ASSERT_TRUE(grows_to("scan.mcap", 20'000)) << recorder.err() << sim.err();
  expect_end(recorder, SIGTERM, 0);
  expect_end(sim, SIGTERM, 0);
  expect_sound("scan.mcap");
  const auto topics = read_topics(path("scan.mcap"));
  ASSERT_EQ(topics.size(), 1U);
  EXPECT_EQ(topics.begin()->first, "scan");
}

TEST_F(LiveRecording, OfTwoHostsOfTheSameComponentsOneIsHeard) {
  Process first = start({"run", "estimator", "planner"});
  Process second = start({"run", "estimator", "planner"});
  for (Process* process : {&first, &second}) {
    EXPECT_TRUE(becomes_true(kStartLimit, [&] {
      return process->err().find("hosting planner") != std::string::npos;
    })) << process->err();
  }
  Process sim = start({"run", "sim", "--scenario", hop()});
  Process recorder = start({"bag", "record", "-o", path("f.mcap"), "odometry"});
  ASSERT_TRUE(grows_to("f.mcap", 50'000)) << recorder.err();
  for (Process* process : {&recorder, &sim, &first, &second}) expect_end(*process, SIGTERM, 0);

  // Each estimator answers to the same measurements: two that are heard would speak of the same
  // moments, or of earlier ones again.
  Time last{};
  const auto topics = read_topics(path("f.mcap"));
  for (const mcap::Bytes& bytes : topics.at("odometry")) {
    const Time stamp = from_msg(from_cdr<nav_msgs::msg::Odometry>(bytes).value().header().stamp());
    EXPECT_GT(stamp, last);
    last = stamp;
  }
}

}  // namespace
}  // namespace swiftlet::test
