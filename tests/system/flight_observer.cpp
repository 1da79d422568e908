// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/flight_observer.hpp"

#include <algorithm>
#include <optional>

#include "components/conversions.hpp"

namespace swiftlet::test {

struct FlightObserver::Reader : Component {
  Reader(const ComponentContext& context, FlightObserver& observer) : Component(context) {
    const auto locked = [&observer](auto use) {
      return [&observer, use](const auto& message) {
        const std::lock_guard<std::mutex> lock(observer.mutex_);
        use(message);
      };
    };
    Seen& seen = observer.seen_;
    subscribe(topic::sim_truth, locked([&seen](const swiftlet_msgs::msg::SimTruth& truth) {
                seen.position = from_msg(truth.pose().position());
                seen.speed = from_msg(truth.twist().linear()).norm();
                seen.on_ground = truth.on_ground();
                seen.contacts = truth.contacts();
                seen.last_contact = truth.last_contact();
              }));
    subscribe(topic::vehicle_status, locked([&](const swiftlet_msgs::msg::VehicleStatus& status) {
                seen.mode = status.mode();
                seen.reason = status.reason();
                seen.waypoint = status.waypoint();
                observer.armed_ = status.armed();
              }));
    watch(topic::setpoint, observer, seen.longest_setpoint_gap);
    watch(topic::odometry, observer, seen.longest_odometry_gap);
    watch(topic::motors, observer, seen.longest_motors_gap);
  }

  template <class T>
  void watch(const Topic<T>& topic, FlightObserver& observer, double& longest) {
    subscribe(topic, [this, &observer, &longest, last = std::optional<Time>()](const T&) mutable {
      const std::lock_guard<std::mutex> lock(observer.mutex_);
      if (last && observer.armed_) longest = std::max(longest, to_seconds(now() - *last));
      last = now();
    });
  }
};

namespace {

HostOptions on_domain(int domain) {
  HostOptions options;
  options.participant.name = "flight_observer";
  options.participant.domain = domain;
  return options;
}

}  // namespace

FlightObserver::FlightObserver(int domain) : host_(on_domain(domain)) {
  host_.emplace<Reader>("flight_observer", *this);
  thread_ = std::thread([this] { host_.run(); });
}

FlightObserver::~FlightObserver() {
  host_.executor().stop(0);
  thread_.join();
}

FlightObserver::Seen FlightObserver::seen() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return seen_;
}

void FlightObserver::forget_gaps() {
  const std::lock_guard<std::mutex> lock(mutex_);
  seen_.longest_setpoint_gap = seen_.longest_odometry_gap = seen_.longest_motors_gap = 0.0;
}

}  // namespace swiftlet::test
