// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// slam_live_bench [SPEED]: how long a scan takes to its pose while the mapper closes loops beside,
// in real time: 1000 beams at 20 Hz, around a block, without odometry. Prints delays of
// `lidar/pose`, those while the back end worked apart.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <vector>

#include "components/conversions.hpp"
#include "components/runtime/host.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/topics.hpp"
#include "tests/bench/block_drive.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Sends the scans, and waits for the poses.
class Driver : public Component {
 public:
  Driver(const ComponentContext& context, const std::vector<test::BlockStep>& steps)
      : Component(context), steps_(steps) {
    scan_ = advertise(topic::scan);
    subscribe(topic::lidar_pose, [this](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) {
      const auto sent = sent_.find(from_msg(pose.header().stamp()));
      if (sent == sent_.end()) return;
      delays_ms.push_back(1e3 * to_seconds(now() - sent->second));
      sent_.erase(sent);
    });
    // The past is moved when a loop has been closed.
    subscribe(topic::lidar_path, [this](const nav_msgs::msg::Path& path) {
      if (path.poses().empty() || poses_known_ == 0) {
        poses_known_ = path.poses().size();
        last_ = path;
        return;
      }
      double moved = 0.0;
      for (std::size_t i = 0; i < std::min(last_.poses().size(), path.poses().size()); ++i) {
        const auto& a = last_.poses()[i].pose().position();
        const auto& b = path.poses()[i].pose().position();
        moved = std::max(moved, std::hypot(a.x() - b.x(), a.y() - b.y()));
      }
      if (moved > 0.005) ++corrections;
      last_ = path;
    });
    every(50ms, [this](Time now) {
      if (scan_.matched_readers() == 0) return;
      if (next_ == steps_.size()) return stop(0);
      sensor_msgs::msg::LaserScan message = to_msg(steps_[next_++].scan);
      message.header(make_header(now, frame::kLaser));
      sent_[from_msg(message.header().stamp())] = this->now();
      scan_.publish(message);
    });
  }

  std::vector<double> delays_ms;
  int corrections = 0;
  std::size_t unanswered() const { return sent_.size(); }

 private:
  const std::vector<test::BlockStep>& steps_;
  std::size_t next_ = 0;
  std::map<Time, Time> sent_;
  std::size_t poses_known_ = 0;
  nav_msgs::msg::Path last_;
  Publisher<sensor_msgs::msg::LaserScan> scan_;
};

int run(double speed) {
  const std::vector<test::BlockStep> steps = test::drive_around_the_block(speed);
  fmt::print("{} scans of {} beams, {:.0f} s\n", steps.size(), test::kBlockBeams,
             static_cast<double>(steps.size()) / test::kBlockRate_hz);
  HostOptions options;
  options.participant.domain = 74;
  Host host(options);
  host.add("lidar_mapper", Config::parse("{slam: true, min_height: 0.0}", "bench"));
  auto& driver = host.emplace<Driver>("driver", steps);
  if (host.run() != 0) return 1;
  std::vector<double>& delays = driver.delays_ms;
  if (delays.empty()) return 1;
  std::sort(delays.begin(), delays.end());
  const auto at = [&delays](double share) {
    return delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))];
  };
  fmt::print(
      "lidar/pose after p50 {:.2f} ms, p99 {:.2f} ms, worst {:.2f} ms; {} scans without; the past "
      "was "
      "corrected {} times\n",
      at(0.5), at(0.99), delays.back(), driver.unanswered(), driver.corrections);
  return 0;
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  return swiftlet::run(argc > 1 ? std::atof(argv[1]) : 1.6);
}
