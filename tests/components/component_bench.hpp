// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "components/conversions.hpp"
#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet::test {

/// A component that the test talks through.
struct Probe : Component {
  using Component::advertise, Component::call_at, Component::every, Component::now, Component::stop,
      Component::subscribe;
  explicit Probe(const ComponentContext& context) : Component(context) {}
};

/// One component under test and a probe; the run ends at a moment of its own clock.
struct Bench {
  Host host{options()};
  Probe& probe;

  explicit Bench(const std::string& component, const std::string& yaml = "")
      : probe(add(host, component, yaml)) {}

  void run_until(Time end) {
    probe.call_at(end, [this](Time) { probe.stop(0); });
    ASSERT_EQ(host.run(), 0);
  }

  template <class T>
  std::vector<T>& record(const Topic<T>& topic) {
    auto heard = std::make_shared<std::vector<T>>();
    probe.subscribe(topic, [heard](const T& message) { heard->push_back(message); });
    return *heard;
  }

  // What the rest of a vehicle at rest would send.
  void send_imu(Time from = Time{}) {
    every(topic::imu0, std::chrono::milliseconds(1), from, [](Time now) {
      sensor_msgs::msg::Imu imu;
      imu.header(make_header(now, frame::kBody));
      imu.linear_acceleration(to_vector3({0, 0, kGravity}));
      return imu;
    });
  }
  void send_odometry(const Eigen::Vector3d& position, Time until = Time::max()) {
    every(
        topic::odometry, std::chrono::milliseconds(4), Time{},
        [position](Time now) {
          RigidBodyState state;
          state.p_WB = position;
          auto odometry = to_odometry(now, state);
          for (std::size_t i = 0; i < 6; ++i) odometry.pose().covariance()[7 * i] = 1e-4;
          return odometry;
        },
        until);
  }
  /// Of a flight controller that misses nothing.
  void send_motors() {
    every(topic::motors, std::chrono::milliseconds(4), Time{},
          [](Time) { return swiftlet_msgs::msg::MotorCommand(); });
    every(topic::component_status, std::chrono::milliseconds(20), Time{}, [](Time now) {
      swiftlet_msgs::msg::ComponentStatus status;
      status.header(make_header(now, ""));
      status.component_name("flight_controller");
      status.instance("the only one");
      status.active(true);
      status.period(0.02);
      return status;
    });
  }

  template <class T, class Make>
  void every(const Topic<T>& topic, Duration period, Time from, Make make,
             Time until = Time::max()) {
    auto publisher = std::make_shared<Publisher<T>>(probe.advertise(topic));
    probe.every(period, [=](Time now) mutable {
      if (now >= from && now < until) publisher->publish(make(now));
    });
  }
  template <class T, class Make>
  void at(Time time, const std::shared_ptr<Publisher<T>>& publisher, Make make) {
    probe.call_at(time, [=](Time now) { publisher->publish(make(now)); });
  }

 private:
  static HostOptions options() {
    HostOptions options;
    options.lockstep = true;
    options.participant.domain = 77;
    return options;
  }
  static Probe& add(Host& host, const std::string& component, const std::string& yaml) {
    host.add(component, yaml.empty() ? Config() : Config::parse(yaml, "test.yaml"));
    return host.emplace<Probe>("probe");
  }
};

}  // namespace swiftlet::test
