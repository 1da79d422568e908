// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// slam_live_bench [SPEED]: how long a scan takes to its pose in real time, 1000 beams at 20 Hz
// around a block without odometry: with loops that are closed beside, and with hardly any. Says of
// the longest delays what the mapper's thread did meanwhile: whether it computed, waited for a
// processor, or was held up by something else.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
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

/// What the kernel counts of a thread [ms]. Waiting that began before a scan is counted whole when
/// it ends.
struct ThreadTimes {
  double computed = 0.0;
  double waited = 0.0;  // for a processor
};
ThreadTimes times_of(pid_t thread) {
  std::ifstream file(fmt::format("/proc/self/task/{}/schedstat", thread));
  double computed_ns = 0.0, waited_ns = 0.0;
  file >> computed_ns >> waited_ns;
  return {computed_ns * 1e-6, waited_ns * 1e-6};
}

/// From a scan to its pose [ms].
struct Delay {
  double whole = 0.0;
  ThreadTimes mapper;
};

/// Sends the scans, and takes the poses as they are delivered, in the mapper's thread.
class Driver : public Component {
 public:
  Driver(const ComponentContext& context, const std::vector<test::BlockStep>& steps)
      : Component(context), steps_(steps) {
    scan_ = advertise(topic::scan);
    subscribe(at_once(topic::lidar_pose),
              [this](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) { hear(pose); });
    // The past is moved when a loop has been closed.
    subscribe(topic::lidar_path, [this](const nav_msgs::msg::Path& path) {
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
      own_thread_ = gettid();
      if (next_ == steps_.size()) return stop(0);
      sensor_msgs::msg::LaserScan message = to_msg(steps_[next_++].scan);
      message.header(make_header(now, frame::kLaser));
      const Time stamp = from_msg(message.header().stamp());
      const ThreadTimes mapper = times_of(mapper_thread_);
      sent_[stamp] = {this->now(), mapper};
      scan_.publish(message);
    });
  }

  std::vector<Delay> delays;
  int corrections = 0;
  std::size_t unanswered() const { return sent_.size(); }

 private:
  struct Sent {
    Time time;
    ThreadTimes mapper;
  };

  void hear(const geometry_msgs::msg::PoseWithCovarianceStamped& pose) {
    const Time time = now();
    if (gettid() != own_thread_) mapper_thread_ = gettid();
    const auto sent = sent_.find(from_msg(pose.header().stamp()));
    if (sent == sent_.end()) return;
    const ThreadTimes then = sent->second.mapper, now = times_of(mapper_thread_);
    if (then.computed > 0.0) {
      delays.push_back({1e3 * to_seconds(time - sent->second.time),
                        {now.computed - then.computed, now.waited - then.waited}});
    }
    sent_.erase(sent);
  }

  const std::vector<test::BlockStep>& steps_;
  std::size_t next_ = 0;
  std::map<Time, Sent> sent_;
  pid_t own_thread_ = 0, mapper_thread_ = 0;
  nav_msgs::msg::Path last_;
  Publisher<sensor_msgs::msg::LaserScan> scan_;
};

constexpr int kDomain = 74;
constexpr std::size_t kLongest = 5;  // delays, told one by one

bool drive(const std::vector<test::BlockStep>& steps, const std::string& name,
           const std::string& parameters) {
  HostOptions options;
  options.participant.domain = kDomain;
  Host host(options);
  host.add("lidar_mapper",
           Config::parse("{slam: true, min_height: 0.0" + parameters + "}", "bench"));
  auto& driver = host.emplace<Driver>("driver", steps);
  if (host.run() != 0) return false;
  std::vector<Delay>& delays = driver.delays;
  if (delays.size() < kLongest) return false;
  std::sort(delays.begin(), delays.end(),
            [](const Delay& a, const Delay& b) { return a.whole < b.whole; });
  const auto at = [&delays](double share) {
    return delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))].whole;
  };
  fmt::print(
      "{}: lidar/pose after p50 {:.2f} ms, p99 {:.2f} ms, worst {:.2f} ms; {} scans without; the "
      "past was corrected {} times\n",
      name, at(0.5), at(0.99), delays.back().whole, driver.unanswered(), driver.corrections);
  for (std::size_t i = 0; i < kLongest; ++i) {
    const Delay& delay = delays[delays.size() - 1 - i];
    fmt::print("  {:6.2f} ms: {:.2f} computing, {:.2f} waiting for a processor, {:.2f} otherwise\n",
               delay.whole, delay.mapper.computed, delay.mapper.waited,
               delay.whole - delay.mapper.computed - delay.mapper.waited);
  }
  return true;
}

int run(double speed) {
  const std::vector<test::BlockStep> steps = test::drive_around_the_block(speed);
  fmt::print("{} scans of {} beams, {:.0f} s, twice\n", steps.size(), test::kBlockBeams,
             static_cast<double>(steps.size()) / test::kBlockRate_hz);
  const bool driven =
      drive(steps, "with loops", "") && drive(steps, "with hardly any", ", loop_radius: 0.001");
  return driven ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  return swiftlet::run(argc > 1 ? std::atof(argv[1]) : 1.6);
}
