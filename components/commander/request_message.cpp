// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/commander/request_message.hpp"

#include <fmt/format.h>

#include <cmath>

#include "components/command_name.hpp"
#include "components/commander/mission_message.hpp"
#include "components/conversions.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

/// Rounded in single precision, a unit quaternion is still nearer to one than this.
constexpr double kNotUnit = 0.01;

swiftlet_msgs::msg::CommandAck named(const std::string& id, const std::string& name,
                                     const std::string& station) {
  swiftlet_msgs::msg::CommandAck ack;
  ack.id(id);
  ack.name(name);
  ack.station(station);
  return ack;
}

}  // namespace

std::optional<Request> request_of(const swiftlet_msgs::msg::ModeCommand& command) {
  using namespace swiftlet_msgs::msg::ModeCommand_Constants;
  switch (command.command()) {
    case ARM:
      return Request::arm();
    case DISARM:
      return Request::disarm();
    case TAKEOFF:
      return Request::takeoff(command.altitude());
    case HOVER:
      return Request::hover();
    case LAND:
      return Request::land();
    case EXPLORE:
      return Request::explore();
    case MANUAL:
      return Request::manual();
    case ASSIST:
      return Request::assist();
    case RETURN:
      return Request::go_back();
    default:
      return std::nullopt;
  }
}

Result<MissionWaypoint> waypoint_of(const geometry_msgs::msg::PoseStamped& goal, double altitude) {
  const std::string& frame = goal.header().frame_id();
  if (!frame.empty() && frame != frame::kMap) {
    return Error{
        fmt::format("goal_pose refused: it is in frame '{}'; send it in '{}'", frame, frame::kMap)};
  }
  const Eigen::Quaterniond attitude = from_msg(goal.pose().orientation());
  MissionWaypoint waypoint;
  waypoint.position = from_msg(goal.pose().position());
  if (!waypoint.position.allFinite() || !attitude.coeffs().allFinite()) {
    return Error{"goal_pose refused: its pose has something that is no number"};
  }
  if (!(std::abs(attitude.norm() - 1.0) < kNotUnit)) {
    return Error{fmt::format(
        "goal_pose refused: its orientation is no unit quaternion, its length is {:.3g}",
        attitude.norm())};
  }
  if (waypoint.position.z() == 0.0) waypoint.position.z() = altitude;
  waypoint.yaw = yaw_of(attitude.normalized());
  return waypoint;
}

std::uint32_t goal_identity(const geometry_msgs::msg::PoseStamped& goal) {
  return checksum(to_cdr(goal.pose()));
}

std::string goal_id(const geometry_msgs::msg::PoseStamped& goal) {
  const auto& stamp = goal.header().stamp();
  return fmt::format("goal_pose {}.{:09} {:08x}", stamp.sec(), stamp.nanosec(),
                     checksum(to_cdr(goal)));
}

swiftlet_msgs::msg::CommandAck asked(const swiftlet_msgs::msg::ModeCommand& command) {
  return named(command.id(), command_name(command.command()), command.station());
}

swiftlet_msgs::msg::CommandAck asked(const swiftlet_msgs::msg::Mission& mission) {
  const std::size_t count = mission.waypoints().size();
  const char* one = is_global(mission) ? "gps" : "goto";
  return named(mission.id(), count == 1 ? one : fmt::format("{} waypoints", count),
               mission.station());
}

swiftlet_msgs::msg::CommandAck asked(const geometry_msgs::msg::PoseStamped& goal) {
  return named(goal_id(goal), "goal_pose", "");
}

Error refused(const swiftlet_msgs::msg::CommandAck& asked, const Error& why) {
  return Error{asked.name() + " refused: " + why.reason};
}

bool has_stamp(const geometry_msgs::msg::PoseStamped& goal) {
  return from_msg(goal.header().stamp()) != Time{};
}

}  // namespace swiftlet
