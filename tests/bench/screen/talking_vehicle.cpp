// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// talking_vehicle SPEED: says what a vehicle in flight says, with a map of 1000 x 1000 cells, SPEED
// times as often, until it is ended. It flies a figure of eight, and every minute its mode changes.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "components/conversions.hpp"
#include "components/lidar_mapper/grid_message.hpp"
#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr int kCells = 1000;
constexpr double kResolution = 0.05;  // [m]

/// Walls along a lattice of rooms, with doors.
OccupancyGrid some_map() {
  OccupancyGrid grid({}, {-25.0, -25.0}, kCells, kCells);
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      const bool is_wall = (x % 100 == 0 && y % 100 > 20) || (y % 100 == 0 && x % 100 > 20);
      grid.set_state({x, y}, is_wall ? CellState::kOccupied : CellState::kFree);
    }
  }
  return grid;
}

class TalkingVehicle : public Component {
 public:
  TalkingVehicle(const ComponentContext& context, double speed)
      : Component(context), speed_(speed), grid_(some_map()) {
    status_ = advertise(topic::vehicle_status);
    odometry_ = advertise(topic::odometry);
    battery_ = advertise(topic::battery);
    map_ = advertise(topic::map);
    path_ = advertise(topic::path);
    begin_ = now();
    speak(20ms, [this](double t) { say_odometry(t); });
    speak(100ms, [this](double t) { say_status(t); });
    speak(200ms, [this](double t) { say_path(t); });
    speak(1s, [this](double t) { say_battery(t); });
    speak(1s, [this](double) { say_map(); });
  }

 private:
  template <class Say>
  void speak(Duration period, Say say) {
    every(from_seconds(to_seconds(period) / speed_),
          [this, say](Time now) { say(speed_ * to_seconds(now - begin_)); });
  }
  static Eigen::Vector3d place(double t) {
    return {15.0 * std::sin(0.05 * t), 8.0 * std::sin(0.1 * t), 1.2};
  }

  void say_odometry(double t) {
    nav_msgs::msg::Odometry message;
    message.header(make_header(now(), frame::kMap));
    message.pose().pose().position(to_point(place(t)));
    message.pose().pose().orientation().w(1.0);
    odometry_.publish(message);
  }
  void say_status(double t) {
    using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
    const int minute = static_cast<int>(t / 60.0);
    swiftlet_msgs::msg::VehicleStatus message;
    message.header(make_header(now(), frame::kMap));
    message.mode(minute % 2 == 0 ? HOVER : INDOOR_NAVIGATION);
    message.armed(true);
    message.ready(true);
    message.reason(fmt::format("minute {}", minute));
    message.height(1.2);
    status_.publish(message);
  }
  void say_path(double t) {
    nav_msgs::msg::Path message;
    message.header(make_header(now(), frame::kMap));
    for (int i = 0; i < 50; ++i) {
      auto& pose = message.poses().emplace_back();
      pose.pose().position(to_point(place(t + 0.2 * i)));
    }
    path_.publish(message);
  }
  void say_battery(double t) {
    sensor_msgs::msg::BatteryState message;
    const double share = 1.0 - std::fmod(t / 3600.0, 1.0);
    message.percentage(static_cast<float>(share));
    message.voltage(static_cast<float>(14.0 + 2.0 * share));
    message.current(-9.0F);
    message.charge(static_cast<float>(3.0 * share));
    battery_.publish(message);
  }
  void say_map() {
    // Each is another than the last, as when one flies.
    const int x = 1 + (maps_++ * 37) % (kCells - 2);
    grid_.set_state({x, 50}, CellState::kOccupied);
    map_.publish(to_msg(grid_, now()));
  }

  double speed_;
  OccupancyGrid grid_;
  Time begin_{};
  int maps_ = 0;
  Publisher<swiftlet_msgs::msg::VehicleStatus> status_;
  Publisher<nav_msgs::msg::Odometry> odometry_;
  Publisher<sensor_msgs::msg::BatteryState> battery_;
  Publisher<nav_msgs::msg::OccupancyGrid> map_;
  Publisher<nav_msgs::msg::Path> path_;
};

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  const double speed = argc == 2 ? std::atof(argv[1]) : 0.0;
  if (!(speed >= 0.1 && speed <= 100.0)) {
    fmt::print(stderr, "usage: talking_vehicle SPEED, from 0.1 to 100\n");
    return 2;
  }
  swiftlet::HostOptions options;
  options.participant.name = "talking_vehicle";
  options.participant.domain = swiftlet::domain_from_environment();
  swiftlet::Host host(options);
  host.emplace<swiftlet::TalkingVehicle>("talking_vehicle", speed);
  return host.run();
}
