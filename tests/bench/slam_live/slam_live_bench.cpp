// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// slam_live_bench [ROUNDS]: how long a scan takes to its pose in real time, 1000 beams at 20 Hz
// around a block without odometry: with loops that are closed beside, and with hardly any, in turn.
// The pose is heard as it is delivered, in the mapper's thread, and by a component that does
// nothing else, in its own. Says of the longest delays what those threads did meanwhile, how much
// of them the program's other threads can have caused, and for how long a processor stood still,
// which no program can help. For that it needs real-time priority.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "components/conversions.hpp"
#include "components/runtime/host.hpp"
#include "components/surroundings/scan_message.hpp"
#include "components/topics.hpp"
#include "tests/bench/block_drive.hpp"
#include "tests/bench/slam_live/standstill_watch.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using geometry_msgs::msg::PoseWithCovarianceStamped;

constexpr int kDomain = 74;
constexpr auto kRest = 20s;
constexpr double kSpeed = 1.6;       // [m/s]
constexpr std::size_t kLongest = 5;  // delays of each kind, told one by one

double milliseconds(const StandstillWatch::Span& span) {
  return std::chrono::duration<double, std::milli>(span.second - span.first).count();
}

/// What the kernel counts of a thread [ms]. Waiting that began before a scan is counted whole when
/// it ends.
struct ThreadTimes {
  double computed = 0.0;
  double waited = 0.0;  // for a processor
  long faults = 0;      // pages that it touched for the first time
};
ThreadTimes operator-(const ThreadTimes& a, const ThreadTimes& b) {
  return {a.computed - b.computed, a.waited - b.waited, a.faults - b.faults};
}
long page_faults_of(pid_t thread) {
  std::ifstream file(fmt::format("/proc/self/task/{}/stat", thread));
  std::string field;
  std::getline(file, field, ')');  // number and name
  for (int i = 0; i < 7; ++i) file >> field;
  long faults = 0;
  file >> faults;
  return faults;
}
ThreadTimes times_of(pid_t thread) {
  std::ifstream file(fmt::format("/proc/self/task/{}/schedstat", thread));
  double computed_ns = 0.0, waited_ns = 0.0;
  file >> computed_ns >> waited_ns;
  return {computed_ns * 1e-6, waited_ns * 1e-6, page_faults_of(thread)};
}
/// Of all threads together [ms].
double computed_by_all() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// One moment, as the bench sees it.
struct Moment {
  StandstillWatch::Clock::time_point time;
  ThreadTimes mapper, listener;
  double all = 0.0;
};

/// The mapper's thread and a listener's; 0 before they are known.
struct Threads {
  std::atomic<pid_t> mapper{0}, listener{0};
  Moment look(StandstillWatch::Clock::time_point now) const {
    return {now, times_of(mapper), times_of(listener), computed_by_all()};
  }
};

/// Hears poses.
class Listener : public Component {
 public:
  Listener(const ComponentContext& context, const Topic<PoseWithCovarianceStamped>& topic,
           const Threads& threads, std::atomic<pid_t>& thread)
      : Component(context) {
    subscribe(topic, [this, &threads, &thread](const PoseWithCovarianceStamped& pose) {
      const auto time = StandstillWatch::Clock::now();
      thread = gettid();
      heard.emplace_back(from_msg(pose.header().stamp()), threads.look(time));
    });
  }
  std::vector<std::pair<Time, Moment>> heard;  // a scan's stamp, and when its pose came
};

/// Counts how often the past is moved, as it is when a loop has been closed.
class PathWatch : public Component {
 public:
  explicit PathWatch(const ComponentContext& context) : Component(context) {
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
  }
  int corrections = 0;

 private:
  nav_msgs::msg::Path last_;
};

/// Sends the scans.
class Driver : public Component {
 public:
  Driver(const ComponentContext& context, const std::vector<test::BlockStep>& steps,
         const Threads& threads)
      : Component(context) {
    scan_ = advertise(topic::scan);
    every(50ms, [this, &steps, &threads](Time) {
      if (scan_.matched_readers() == 0) return;
      if (sent.size() == steps.size()) return stop(0);
      sensor_msgs::msg::LaserScan message = to_msg(steps[sent.size()].scan);
      const Moment moment = threads.look(StandstillWatch::Clock::now());
      message.header(make_header(now(), frame::kLaser));
      sent.emplace_back(from_msg(message.header().stamp()), moment);
      scan_.publish(message);
    });
  }
  std::vector<std::pair<Time, Moment>> sent;

 private:
  Publisher<sensor_msgs::msg::LaserScan> scan_;
};

/// From a scan to its pose.
struct Delay {
  double whole = 0.0;  // [ms]
  double still = 0.0;  // of it a processor stood still [ms]
  ThreadTimes mapper, listener;
  double others = 0.0;  // computing of all other threads, the back end's before all [ms]

  double without_standstills() const { return whole - still; }
  /// At most how long it waited for a processor that another thread had [ms].
  double behind_others() const {
    return std::max(0.0, std::min(mapper.waited + listener.waited - still, others));
  }
};

std::vector<Delay> delays_of(const Driver& driver, const Listener& listener,
                             const StandstillWatch& watch) {
  std::vector<Delay> delays;
  auto sent = driver.sent.begin();
  for (const auto& [scan, then] : listener.heard) {
    while (sent != driver.sent.end() && sent->first < scan) ++sent;
    if (sent == driver.sent.end()) break;
    if (sent->first != scan || sent->second.mapper.computed == 0.0) continue;
    Delay delay;
    delay.whole = milliseconds({sent->second.time, then.time});
    delay.still = watch.within({sent->second.time, then.time});
    delay.mapper = then.mapper - sent->second.mapper;
    delay.listener = then.listener - sent->second.listener;
    delay.others = then.all - sent->second.all - delay.mapper.computed - delay.listener.computed;
    delays.push_back(delay);
  }
  std::sort(delays.begin(), delays.end(),
            [](const Delay& a, const Delay& b) { return a.whole < b.whole; });
  return delays;
}

void tell(const StandstillWatch& watch) {
  double sum = 0.0, longest = 0.0;
  for (const auto& span : watch.spans()) {
    sum += milliseconds(span);
    longest = std::max(longest, milliseconds(span));
  }
  fmt::print("  a processor stood still {} times, {:.1f} ms in all, {:.2f} ms at most\n",
             watch.spans().size(), sum, longest);
}

/// Of one place and kind of drive, over all rounds.
struct Series {
  std::string name;
  std::vector<double> worst, worst_without_standstills, most_behind_others;

  void add(const std::vector<Delay>& delays) {
    const auto at = [&delays](double share) {
      return delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))].whole;
    };
    const auto most = [&delays](auto part) {
      double longest = 0.0;
      for (const Delay& delay : delays) longest = std::max(longest, (delay.*part)());
      return longest;
    };
    worst.push_back(delays.back().whole);
    worst_without_standstills.push_back(most(&Delay::without_standstills));
    most_behind_others.push_back(most(&Delay::behind_others));
    fmt::print(
        "  {}: p50 {:.2f} ms, p99 {:.2f}, worst {:.2f}, without standstills {:.2f}; waited behind "
        "other threads {:.2f} at most\n",
        name, at(0.5), at(0.99), worst.back(), worst_without_standstills.back(),
        most_behind_others.back());
    for (std::size_t i = 0; i < kLongest; ++i) {
      const Delay& delay = delays[delays.size() - 1 - i];
      fmt::print(
          "    {:6.2f} ms: a processor stood still {:.2f}; mapper computed {:.2f}, {} page "
          "faults, waited for a processor {:.2f}; listener {:.2f}, {:.2f}; others computed "
          "{:.2f}\n",
          delay.whole, delay.still, delay.mapper.computed, delay.mapper.faults, delay.mapper.waited,
          delay.listener.computed, delay.listener.waited, delay.others);
    }
  }
  void sum_up(const std::string& kind) {
    const auto range = [](std::vector<double> values) {
      std::sort(values.begin(), values.end());
      return fmt::format("{:.2f} to {:.2f} ms, median {:.2f}", values.front(), values.back(),
                         values[values.size() / 2]);
    };
    fmt::print(
        "{}, {}: worst of a drive {}; without standstills {}; waited behind other threads {}\n",
        kind, name, range(worst), range(worst_without_standstills), range(most_behind_others));
  }
};

struct Kind {
  std::string name, parameters;
  Series delivered{"delivered", {}, {}, {}}, received{"received", {}, {}, {}};
};

bool no_priority() {
  fmt::print(stderr,
             "no real-time priority, so that nobody can tell when a processor stands still: run it "
             "as root, or allow it with `ulimit -r 99`\n");
  return false;
}

/// How often processors stand still while nothing runs.
bool rest() {
  StandstillWatch watch;
  std::this_thread::sleep_for(kRest);
  if (!watch.finish()) return no_priority();
  fmt::print("at rest, {} s\n", kRest.count());
  tell(watch);
  return true;
}

bool drive(const std::vector<test::BlockStep>& steps, Kind& kind) {
  HostOptions options;
  options.participant.domain = kDomain;
  Host host(options);
  Threads threads;
  host.add("lidar_mapper",
           Config::parse("{slam: true, min_height: 0.0" + kind.parameters + "}", "bench"));
  const auto& delivered =
      host.emplace<Listener>("delivered", at_once(topic::lidar_pose), threads, threads.mapper);
  const auto& received =
      host.emplace<Listener>("received", topic::lidar_pose, threads, threads.listener);
  const auto& path = host.emplace<PathWatch>("path_watch");
  const auto& driver = host.emplace<Driver>("driver", steps, threads);
  StandstillWatch watch;
  if (host.run() != 0) return false;
  if (!watch.finish()) return no_priority();
  const std::vector<Delay> first = delays_of(driver, delivered, watch),
                           second = delays_of(driver, received, watch);
  if (std::min(first.size(), second.size()) < kLongest) {
    fmt::print(stderr,
               "too few poses, or the kernel does not count times of threads "
               "(/proc/self/task/*/schedstat)\n");
    return false;
  }
  fmt::print("{}: {} scans, {} and {} poses; the past was corrected {} times\n", kind.name,
             driver.sent.size(), first.size(), second.size(), path.corrections);
  tell(watch);
  kind.delivered.add(first);
  kind.received.add(second);
  return true;
}

int run(int rounds) {
  const std::vector<test::BlockStep> steps = test::drive_around_the_block(kSpeed);
  fmt::print("{} scans of {} beams, {:.0f} s, {} times\n", steps.size(), test::kBlockBeams,
             static_cast<double>(steps.size()) / test::kBlockRate_hz, 2 * rounds);
  std::vector<Kind> kinds{{"with loops", ""}, {"with hardly any", ", loop_radius: 0.001"}};
  for (int round = 0; round < rounds; ++round) {
    if (!rest()) return 1;
    for (Kind& kind : kinds) {
      if (!drive(steps, kind)) return 1;
    }
  }
  for (Kind& kind : kinds) {
    for (Series* series : {&kind.delivered, &kind.received}) series->sum_up(kind.name);
  }
  return 0;
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  return swiftlet::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 3);
}
