// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <any>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "components/bag/mcap/writer.hpp"
#include "components/bag/recording.hpp"
#include "components/bag/topic_file.hpp"
#include "components/conversions.hpp"
#include "components/report/story_reader.hpp"
#include "components/topics.hpp"

namespace swiftlet {

/// Where the clock of a made-up recording begins [s].
inline constexpr double kMadeUpBegin = 50.0;

inline Time at(double time) {
  return Time(from_seconds(kMadeUpBegin + time));
}

/// A recording that a test makes up, message by message in any order.
class MadeUpRecording {
 public:
  explicit MadeUpRecording(std::filesystem::path file) : file_(std::move(file)) {
    mcap::WriterParams params;
    params.profile = "ros2";
    params.overwrite = true;
    auto writer = mcap::Writer::open(file_, params);
    EXPECT_TRUE(writer.ok());
    writer_.emplace(std::move(*writer));
  }

  /// A message that is recorded `time` seconds after the beginning.
  template <class T>
  void add(const std::string& topic, double time, const T& message) {
    auto& writer = writers_[topic];
    if (!writer.has_value()) {
      writer = TopicWriter<T>();
      ASSERT_TRUE(std::any_cast<TopicWriter<T>&>(writer).open(*writer_, topic).ok());
    }
    ASSERT_TRUE(std::any_cast<TopicWriter<T>&>(writer).write(*writer_, at(time), message).ok());
  }
  void add(const mcap::Metadata& metadata) { ASSERT_TRUE(writer_->write(metadata).ok()); }

  Recording close() {
    EXPECT_TRUE(writer_->close().ok());
    return reopen();
  }
  /// As it is on disk, without an end.
  Recording leave_open() {
    EXPECT_TRUE(writer_->flush().ok());
    return reopen();
  }

 private:
  Recording reopen() const {
    auto recording = Recording::open({file_});
    if (!recording.ok()) throw std::runtime_error(recording.error().reason);
    return *recording;
  }

  std::filesystem::path file_;
  std::optional<mcap::Writer> writer_;
  std::map<std::string, std::any> writers_;
};

inline nav_msgs::msg::Odometry odometry_at(double time, const Eigen::Vector3d& position,
                                           const Eigen::Vector3d& velocity = {0, 0, 0}) {
  RigidBodyState state;
  state.p_WB = position;
  state.v_WB_W = velocity;
  return to_odometry(at(time), state);
}

inline swiftlet_msgs::msg::Setpoint setpoint_at(double time, const Eigen::Vector3d& position) {
  swiftlet_msgs::msg::Setpoint setpoint;
  setpoint.header(make_header(at(time), "map"));
  setpoint.kind(swiftlet_msgs::msg::Setpoint_Constants::TRACK);
  FlatReference reference;
  reference.position = position;
  set_reference(reference, setpoint);
  return setpoint;
}

inline swiftlet_msgs::msg::VehicleStatus status_at(double time, std::uint8_t mode,
                                                   const std::string& reason = "") {
  swiftlet_msgs::msg::VehicleStatus status;
  status.header(make_header(at(time), "map"));
  status.mode(mode);
  status.reason(reason);
  status.takeoff_point(to_point({1.0, 2.0, 0.1}));
  return status;
}

/// The story of what was made up; a failure of the test where there is none.
inline FlightStory told(const Recording& recording, const std::string& vehicle = "") {
  auto story = read_story(recording, vehicle);
  if (!story.ok()) throw std::runtime_error(story.error().reason);
  return std::move(story).value();
}

inline std::vector<std::string> texts_of(const FlightStory& story, const std::string& kind) {
  std::vector<std::string> texts;
  for (const FlightEvent& event : story.events.sorted()) {
    if (event.kind == kind) texts.push_back(event.text);
  }
  return texts;
}

}  // namespace swiftlet
