// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What a ROS 2 node on Cyclone DDS is on the wire: names of topics and types, and the quality of
// service that its tools use. It prints what it hears, a line of JSON a sample, or sends a goal.
#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry_msgs.h"
#include "tests/cyclone/cyclone_json.hpp"

namespace swiftlet::test {
namespace {

/// Loopback only, found without multicast.
constexpr const char* kConfiguration =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery>"
    "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>31"
    "</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers>"
    "</Discovery></Domain></CycloneDDS>";

constexpr dds_duration_t kPatience = DDS_SECS(15);

dds_entity_t checked(dds_entity_t entity) {
  if (entity < 0) throw std::runtime_error(dds_strretcode(-entity));
  return entity;
}

struct Quality {
  bool reliable;
  bool transient_local;
  int depth;
};
// rmw_qos_profile_default, rmw_qos_profile_sensor_data; tf2_ros's for static transforms; RViz's for
// maps; rmw_dds_common's for itself.
constexpr Quality kDefault{true, false, 10};
constexpr Quality kSensorData{false, false, 5};
constexpr Quality kStaticTransforms{true, true, 100};
constexpr Quality kLatched{true, true, 1};
constexpr Quality kGoal{true, false, 1};

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

Qos qos_of(const Quality& quality) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(),
                       quality.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  dds_qset_durability(qos.get(), quality.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                         : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  return qos;
}

/// "nav_msgs::msg::Odometry", as idlc has it, is nav_msgs::msg::dds_::Odometry_ in ROS 2.
std::string ros_name(const std::string& type) {
  const std::size_t name = type.rfind("::") + 2;
  return type.substr(0, name) + "dds_::" + type.substr(name) + "_";
}

dds_entity_t make_topic(dds_entity_t participant, const dds_topic_descriptor_t& idl,
                        const std::string& name) {
  const std::string type = ros_name(idl.m_typename);
  dds_topic_descriptor_t descriptor = idl;
  descriptor.m_typename = type.c_str();
  return checked(dds_create_topic(participant, &descriptor, name.c_str(), nullptr, nullptr));
}

std::string hex(const dds_guid_t& guid) {
  std::string text;
  for (const std::uint8_t byte : guid.v) text += fmt::format("{:02x}", byte);
  return text;
}

/// The GUID of the writer of a sample, as discovery told it.
std::string writer_of(dds_entity_t reader, const dds_sample_info_t& info) {
  dds_builtintopic_endpoint_t* writer =
      dds_get_matched_publication_data(reader, info.publication_handle);
  if (writer == nullptr) return "";
  const std::string guid = hex(writer->key);
  dds_builtintopic_free_endpoint(writer);
  return guid;
}

struct Input {
  const dds_topic_descriptor_t* type;
  Quality quality;
  std::function<Json(const void*)> to_json;
};

template <class T>
Input input(const dds_topic_descriptor_t& type, const Quality& quality) {
  return {&type, quality,
          [](const void* sample) { return json_of(*static_cast<const T*>(sample)); }};
}

const std::map<std::string, Input>& inputs() {
  static const std::map<std::string, Input> all{
      {"odometry", input<nav_msgs_msg_Odometry>(nav_msgs_msg_Odometry_desc, kDefault)},
      {"scan", input<sensor_msgs_msg_LaserScan>(sensor_msgs_msg_LaserScan_desc, kSensorData)},
      {"image", input<sensor_msgs_msg_Image>(sensor_msgs_msg_Image_desc, kSensorData)},
      {"points", input<sensor_msgs_msg_PointCloud2>(sensor_msgs_msg_PointCloud2_desc, kSensorData)},
      {"map", input<nav_msgs_msg_OccupancyGrid>(nav_msgs_msg_OccupancyGrid_desc, kLatched)},
      {"path", input<nav_msgs_msg_Path>(nav_msgs_msg_Path_desc, kDefault)},
      {"tf", input<tf2_msgs_msg_TFMessage>(tf2_msgs_msg_TFMessage_desc, kDefault)},
      {"tf_static", input<tf2_msgs_msg_TFMessage>(tf2_msgs_msg_TFMessage_desc, kStaticTransforms)},
      {"ros_discovery_info", input<rmw_dds_common_msg_ParticipantEntitiesInfo>(
                                 rmw_dds_common_msg_ParticipantEntitiesInfo_desc, kLatched)}};
  return all;
}

/// Prints the samples of one topic. Called by Cyclone's threads.
class Listener {
 public:
  Listener(dds_entity_t participant, const std::string& vehicle, const std::string& topic)
      : topic_(topic), input_(inputs().at(topic)) {
    const std::string prefix = vehicle.empty() ? "rt/" : "rt/" + vehicle + "/";
    const bool is_bare = topic == "ros_discovery_info";
    dds_listener_t* listener = dds_create_listener(this);
    dds_lset_data_available(listener, [](dds_entity_t reader, void* self) {
      static_cast<Listener*>(self)->take(reader);
    });
    checked(dds_create_reader(
        participant, make_topic(participant, *input_.type, is_bare ? topic : prefix + topic),
        qos_of(input_.quality).get(), listener));
    dds_delete_listener(listener);
  }

 private:
  void take(dds_entity_t reader) {
    static std::mutex one_line_at_a_time;
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) > 0) {
      if (info.valid_data) {
        const Json line{{"topic", topic_},
                        {"writer", writer_of(reader, info)},
                        {"message", input_.to_json(sample)}};
        const std::lock_guard<std::mutex> lock(one_line_at_a_time);
        fmt::print("{}\n", line.dump());
        std::fflush(stdout);
      }
      dds_return_loan(reader, &sample, 1);
    }
  }

  std::string topic_;
  Input input_;
};

/// Until SIGTERM.
int listen(dds_entity_t participant, const std::string& vehicle,
           const std::vector<std::string>& topics) {
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  std::vector<std::unique_ptr<Listener>> listeners;
  for (const std::string& topic : topics) {
    listeners.push_back(std::make_unique<Listener>(participant, vehicle, topic));
  }
  int signal = 0;
  sigwait(&end, &signal);
  checked(dds_delete(participant));  // ends the callbacks before the listeners go
  return 0;
}

/// The GUIDs of who reads what a writer writes.
Json readers_of(dds_entity_t writer) {
  std::vector<dds_instance_handle_t> handles(32);
  const dds_return_t count =
      checked(dds_get_matched_subscriptions(writer, handles.data(), handles.size()));
  Json readers = Json::array();
  for (int i = 0; i < std::min<int>(count, static_cast<int>(handles.size())); ++i) {
    dds_builtintopic_endpoint_t* reader =
        dds_get_matched_subscription_data(writer, handles[static_cast<std::size_t>(i)]);
    if (reader == nullptr) continue;
    readers.push_back(hex(reader->key));
    dds_builtintopic_free_endpoint(reader);
  }
  return readers;
}

/// As RViz's "2D Goal Pose" does: one message, and it has arrived when this ends with 0. Prints who
/// it has arrived at.
int send_goal(dds_entity_t participant, const std::string& vehicle, const std::string& frame,
              const std::vector<double>& numbers) {
  const std::string prefix = vehicle.empty() ? "rt/" : "rt/" + vehicle + "/";
  const dds_entity_t topic =
      make_topic(participant, geometry_msgs_msg_PoseStamped_desc, prefix + "goal_pose");
  const dds_entity_t writer =
      checked(dds_create_writer(participant, topic, qos_of(kGoal).get(), nullptr));
  checked(dds_set_status_mask(writer, DDS_PUBLICATION_MATCHED_STATUS));
  const dds_entity_t matched = checked(dds_create_waitset(participant));
  checked(dds_waitset_attach(matched, writer, 0));
  if (checked(dds_waitset_wait(matched, nullptr, 0, kPatience)) == 0) {
    fmt::print(stderr, "nobody reads goal_pose\n");
    return 1;
  }
  std::string frame_id = frame;
  geometry_msgs_msg_PoseStamped goal{};
  const dds_time_t now = dds_time();
  goal.header.stamp.sec = static_cast<std::int32_t>(now / DDS_NSECS_IN_SEC);
  goal.header.stamp.nanosec = static_cast<std::uint32_t>(now % DDS_NSECS_IN_SEC);
  goal.header.frame_id = frame_id.data();
  goal.pose.position = {numbers.at(0), numbers.at(1), numbers.at(2)};
  goal.pose.orientation.z = std::sin(0.5 * numbers.at(3));
  goal.pose.orientation.w = std::cos(0.5 * numbers.at(3));
  checked(dds_write(writer, &goal));
  checked(dds_wait_for_acks(writer, kPatience));
  fmt::print("{}\n", readers_of(writer).dump());
  return 0;
}

int run(const std::vector<std::string>& arguments) {
  setenv("CYCLONEDDS_URI", kConfiguration, 1);
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  const dds_entity_t participant = checked(dds_create_participant(
      static_cast<dds_domainid_t>(domain == nullptr ? 0 : std::stoi(domain)), nullptr, nullptr));
  const std::string vehicle = arguments[1] == "-" ? "" : arguments[1];
  const std::vector<std::string> rest(arguments.begin() + 2, arguments.end());
  if (arguments[0] == "listen") return listen(participant, vehicle, rest);
  std::vector<double> numbers;
  for (std::size_t i = 1; i < rest.size(); ++i) numbers.push_back(std::stod(rest[i]));
  return send_goal(participant, vehicle, rest.at(0), numbers);
}

}  // namespace
}  // namespace swiftlet::test

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  const bool listens = words.size() >= 3 && words[0] == "listen";
  const bool sends = words.size() == 7 && words[0] == "goal";
  if (!listens && !sends) {
    fmt::print(stderr,
               "usage: {0} listen VEHICLE|- TOPIC... | {0} goal VEHICLE|- FRAME X Y Z YAW\n",
               arguments[0]);
    return 2;
  }
  // For sigwait(), in every thread that Cyclone starts.
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &end, nullptr);
  try {
    return swiftlet::test::run(words);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
