// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/cyclone/cyclone_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace swiftlet::test {
namespace {

Json json_of(float number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
  return std::strtod(fmt::format("{}", number).c_str(), nullptr);
}
Json json_of(std::uint8_t number) {
  return number;
}
Json json_of(std::int8_t number) {
  return number;
}
Json json_of(double number) {
  return number;
}

/// Declared before the lists, whose elements they are.
Json json_of(const sensor_msgs_msg_PointField& field);
Json json_of(const geometry_msgs_msg_PoseStamped& message);
Json json_of(const geometry_msgs_msg_TransformStamped& transform);
Json json_of(const rmw_dds_common_msg_NodeEntitiesInfo& node);
Json json_of(const rmw_dds_common_msg_Gid& gid);

template <class T, std::size_t N>
Json list_of(const T (&array)[N]) {
  Json list = Json::array();
  for (const T& element : array) list.push_back(json_of(element));
  return list;
}

template <class Sequence>
Json list_of(const Sequence& sequence) {
  Json list = Json::array();
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    list.push_back(json_of(sequence._buffer[i]));
  }
  return list;
}

Json json_of(const builtin_interfaces_msg_Time& stamp) {
  return {{"sec", stamp.sec}, {"nanosec", stamp.nanosec}};
}
Json json_of(const std_msgs_msg_Header& header) {
  return {{"stamp", json_of(header.stamp)}, {"frame_id", header.frame_id}};
}
Json json_of(const geometry_msgs_msg_Point& point) {
  return {{"x", point.x}, {"y", point.y}, {"z", point.z}};
}
Json json_of(const geometry_msgs_msg_Vector3& vector) {
  return {{"x", vector.x}, {"y", vector.y}, {"z", vector.z}};
}
Json json_of(const geometry_msgs_msg_Quaternion& q) {
  return {{"x", q.x}, {"y", q.y}, {"z", q.z}, {"w", q.w}};
}
Json json_of(const geometry_msgs_msg_Pose& pose) {
  return {{"position", json_of(pose.position)}, {"orientation", json_of(pose.orientation)}};
}
Json json_of(const geometry_msgs_msg_PoseStamped& message) {
  return {{"header", json_of(message.header)}, {"pose", json_of(message.pose)}};
}
Json json_of(const geometry_msgs_msg_TransformStamped& transform) {
  return {{"header", json_of(transform.header)},
          {"child_frame_id", transform.child_frame_id},
          {"transform",
           {{"translation", json_of(transform.transform.translation)},
            {"rotation", json_of(transform.transform.rotation)}}}};
}
Json json_of(const sensor_msgs_msg_PointField& field) {
  return {{"name", field.name},
          {"offset", field.offset},
          {"datatype", field.datatype},
          {"count", field.count}};
}
Json json_of(const rmw_dds_common_msg_Gid& gid) {
  return {{"data", list_of(gid.data)}};
}
Json json_of(const rmw_dds_common_msg_NodeEntitiesInfo& node) {
  return {{"node_namespace", node.node_namespace},
          {"node_name", node.node_name},
          {"reader_gid_seq", list_of(node.reader_gid_seq)},
          {"writer_gid_seq", list_of(node.writer_gid_seq)}};
}

}  // namespace

Json json_of(const nav_msgs_msg_OccupancyGrid& message) {
  return {{"header", json_of(message.header)},
          {"info",
           {{"map_load_time", json_of(message.info.map_load_time)},
            {"resolution", json_of(message.info.resolution)},
            {"width", message.info.width},
            {"height", message.info.height},
            {"origin", json_of(message.info.origin)}}},
          {"data", list_of(message.data)}};
}

Json json_of(const nav_msgs_msg_Odometry& message) {
  return {
      {"header", json_of(message.header)},
      {"child_frame_id", message.child_frame_id},
      {"pose",
       {{"pose", json_of(message.pose.pose)}, {"covariance", list_of(message.pose.covariance)}}},
      {"twist",
       {{"twist",
         {{"linear", json_of(message.twist.twist.linear)},
          {"angular", json_of(message.twist.twist.angular)}}},
        {"covariance", list_of(message.twist.covariance)}}}};
}

Json json_of(const nav_msgs_msg_Path& message) {
  return {{"header", json_of(message.header)}, {"poses", list_of(message.poses)}};
}

Json json_of(const rmw_dds_common_msg_ParticipantEntitiesInfo& message) {
  return {{"gid", json_of(message.gid)},
          {"node_entities_info_seq", list_of(message.node_entities_info_seq)}};
}

Json json_of(const sensor_msgs_msg_Image& message) {
  return {{"header", json_of(message.header)},
          {"height", message.height},
          {"width", message.width},
          {"encoding", message.encoding},
          {"is_bigendian", message.is_bigendian},
          {"step", message.step},
          {"data", list_of(message.data)}};
}

Json json_of(const sensor_msgs_msg_LaserScan& message) {
  return {{"header", json_of(message.header)},
          {"angle_min", json_of(message.angle_min)},
          {"angle_max", json_of(message.angle_max)},
          {"angle_increment", json_of(message.angle_increment)},
          {"time_increment", json_of(message.time_increment)},
          {"scan_time", json_of(message.scan_time)},
          {"range_min", json_of(message.range_min)},
          {"range_max", json_of(message.range_max)},
          {"ranges", list_of(message.ranges)},
          {"intensities", list_of(message.intensities)}};
}

Json json_of(const sensor_msgs_msg_PointCloud2& message) {
  return {{"header", json_of(message.header)},
          {"height", message.height},
          {"width", message.width},
          {"fields", list_of(message.fields)},
          {"is_bigendian", message.is_bigendian},
          {"point_step", message.point_step},
          {"row_step", message.row_step},
          {"data", list_of(message.data)},
          {"is_dense", message.is_dense}};
}

Json json_of(const tf2_msgs_msg_TFMessage& message) {
  return {{"transforms", list_of(message.transforms)}};
}

}  // namespace swiftlet::test
