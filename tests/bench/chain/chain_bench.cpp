// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// chain_bench PID SECONDS: the way of a phone's pose through a running vehicle, in real time.
//
// Every 4 ms a datagram with a pose goes to phone_link. As soon as that has published it, an IMU
// sample follows, which makes the estimator publish the state with the pose in it, and as soon as
// that is there a second one, which makes the flight controller use it. What is timed is datagram
// to motor command: three processes' hops that depend on each other, nothing overlaps. PID is the
// vehicle's process, whose CPU time is counted.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "components/conversions.hpp"
#include "components/phone_link/pose_datagram.hpp"
#include "components/phone_link/udp_socket.hpp"
#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 4ms;
constexpr Duration kWarmUp = 3s;
constexpr IpAddress kLoopback = 0x7f000001;
constexpr std::uint16_t kPort = 8787;

/// User and system time of a process so far [s].
double cpu_seconds(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

class ChainProbe : public Component {
 public:
  ChainProbe(const ComponentContext& context, std::string pid, double seconds)
      : Component(context),
        pid_(std::move(pid)),
        measured_(from_seconds(seconds)),
        socket_(UdpSocket::open().value()) {
    imu_ = advertise(topic::imu0);
    setpoint_ = advertise(topic::setpoint);
    subscribe(at_once(topic::phone_pose),
              [this](const geometry_msgs::msg::PoseWithCovarianceStamped&) {
                if (step_ == Step::kPose) send_imu(Step::kEstimate);
              });
    subscribe(at_once(topic::odometry), [this](const nav_msgs::msg::Odometry& odometry) {
      if (step_ == Step::kEstimate && from_msg(odometry.header().stamp()) >= imu_time_) {
        send_imu(Step::kMotors);
      }
    });
    subscribe(at_once(topic::motors), [this](const swiftlet_msgs::msg::MotorCommand& motors) {
      if (step_ != Step::kMotors || from_msg(motors.stamp()) < imu_time_) return;
      step_ = Step::kDone;
      if (measuring_) latencies_us_.push_back(1e6 * to_seconds(now() - sent_));
    });
    every(kPeriod, [this](Time now) { tick(now); });
  }

  /// One line for people.
  std::string summary() {
    std::sort(latencies_us_.begin(), latencies_us_.end());
    if (latencies_us_.empty()) return "no pose came through to the motors";
    const auto quantile = [this](double q) {
      return latencies_us_[static_cast<std::size_t>(q * double(latencies_us_.size() - 1))];
    };
    return fmt::format(
        "datagram to motor command, {} poses at 250 Hz, {} without an answer within 4 ms\n"
        "p50 {:.0f} us, p90 {:.0f} us, p99 {:.0f} us, p99.9 {:.0f} us, worst {:.0f} us\n"
        "CPU of the vehicle's process: {:.1f} % of one core",
        latencies_us_.size() + missed_, missed_, quantile(0.5), quantile(0.9), quantile(0.99),
        quantile(0.999), latencies_us_.back(), 100.0 * cpu_share_);
  }

 private:
  enum class Step { kPose, kEstimate, kMotors, kDone };

  void tick(Time now) {
    if (!begin_) begin_ = now;
    if (!measuring_ && now - *begin_ > kWarmUp) {
      measuring_ = true;
      measuring_since_ = now;
      cpu_before_ = cpu_seconds(pid_);
    } else if (measuring_ && step_ != Step::kDone) {
      ++missed_;
    }
    if (measuring_ && now - measuring_since_ > measured_) {
      cpu_share_ = (cpu_seconds(pid_) - cpu_before_) / to_seconds(now - measuring_since_);
      stop(0);
      return;
    }
    swiftlet_msgs::msg::Setpoint setpoint;
    setpoint.header(make_header(now, frame::kMap));
    setpoint.kind(swiftlet_msgs::msg::Setpoint_Constants::TRACK);
    set_reference({}, setpoint);
    setpoint_.publish(setpoint);
    if (!phone_is_there(now)) {
      send_imu(Step::kDone);
      return;
    }
    PhonePose pose;
    pose.session = 1;
    pose.sequence = ++sequence_;
    pose.time = now.time_since_epoch();
    // Moves by a millimetre to and fro, so that no pose is as the last.
    pose.position.x() = 1e-3 * (sequence_ % 2);
    const DatagramBytes bytes = encode_binary(pose);
    step_ = Step::kPose;
    sent_ = this->now();
    (void)socket_.send(bytes.data(), bytes.size(), {kLoopback, kPort});
  }

  /// Readers and writers find each other in the first second.
  bool phone_is_there(Time now) const { return now - *begin_ > 1s; }

  void send_imu(Step next) {
    imu_time_ = now();
    sensor_msgs::msg::Imu imu;
    imu.header(make_header(imu_time_, frame::kImu[0]));
    imu.linear_acceleration(to_vector3({0, 0, kGravity}));
    step_ = next;
    imu_.publish(imu);
  }

  std::string pid_;
  Duration measured_;
  UdpSocket socket_;
  std::optional<Time> begin_;
  bool measuring_ = false;
  Time measuring_since_{};
  Step step_ = Step::kDone;
  Time sent_{}, imu_time_{};
  std::uint32_t sequence_ = 0;
  std::size_t missed_ = 0;
  std::vector<double> latencies_us_;
  double cpu_before_ = 0.0, cpu_share_ = 0.0;
  Publisher<sensor_msgs::msg::Imu> imu_;
  Publisher<swiftlet_msgs::msg::Setpoint> setpoint_;
};

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: chain_bench PID SECONDS\n");
    return 2;
  }
  swiftlet::HostOptions options;
  options.participant.name = "chain_bench";
  options.participant.domain = swiftlet::domain_from_environment();
  swiftlet::Host host(options);
  auto& probe = host.emplace<swiftlet::ChainProbe>("chain_probe", argv[1], std::atof(argv[2]));
  const int code = host.run();
  fmt::print("{}\n", probe.summary());
  return code;
}
