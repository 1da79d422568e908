// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/slam/slam_benchmark.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

#include "components/bag/convert_carmen.hpp"
#include "components/bag/recording.hpp"
#include "components/conversions.hpp"
#include "components/experiments/slam/laser_logs.hpp"
#include "components/experiments/slam/odometry_times.hpp"
#include "components/lidar_mapper/map_keeper.hpp"
#include "components/replay/replay_components.hpp"
#include "components/runtime/host.hpp"
#include "components/topics.hpp"
#include "estimation/geometry/so3.hpp"
#include "perception/map_io.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

/// What others have reached on a log, and what we set out for.
struct Published {
  const char* name;  ///< of the log
  double translation;
  const char* source;
  std::optional<double> goal;
};
constexpr Published kPublished[] = {
    {"intel", 0.031, "graph mapping, Kuemmerle et al. 2009", 0.050},
    {"intel2672", 0.031, "graph mapping, Kuemmerle et al. 2009", 0.100},
    {"fr079", 0.0452, "Cartographer, Hess et al. 2016", 0.040},
};
constexpr double kLeastSpeed = 50.0;  // times real time, on one core

TimedPose2 timed(const geometry_msgs::msg::Pose& pose, const builtin_interfaces::msg::Time& stamp) {
  return {to_seconds(from_msg(stamp)),
          {{pose.position().x(), pose.position().y()}, yaw_of(from_msg(pose.orientation()))}};
}

/// Hears where the mapper thinks that scans were taken: at once, and in the end.
class PoseKeeper : public Component {
 public:
  explicit PoseKeeper(const ComponentContext& context) : Component(context) {
    subscribe(topic::lidar_pose,
              [this](const geometry_msgs::msg::PoseWithCovarianceStamped& message) {
                live.push_back(timed(message.pose().pose(), message.header().stamp()));
              });
    subscribe(topic::lidar_path, [this](const nav_msgs::msg::Path& path) {
      last.clear();
      for (const auto& pose : path.poses())
        last.push_back(timed(pose.pose(), pose.header().stamp()));
    });
  }
  std::vector<TimedPose2> live, last;
};

struct Mapped {
  std::vector<TimedPose2> live, last;
  std::optional<OccupancyGrid> map;
  double cpu_s = 0.0;
};

/// The log as a recording, and that through the mapper.
Result<Mapped> map_log(const carmen::Log& log, const fs::path& recording_file) {
  const auto converted = convert_carmen(log, recording_file);
  if (!converted.ok()) return converted.error();
  const auto recording = Recording::open({recording_file});
  if (!recording.ok()) return recording.error();
  HostOptions options;
  options.lockstep = true;
  options.start = mcap::to_time(recording->statistics().message_start_time);
  const auto state =
      std::make_shared<ReplayState>(ReplayState{RecordedEvents(*recording, {}, {}), {}, {}});
  Host host(options);
  host.emplace<ReplaySource>("replay", *recording, state);
  Config parameters;
  parameters.set("slam", "true");
  host.add("lidar_mapper", parameters);
  auto& poses = host.emplace<PoseKeeper>("pose_keeper");
  auto& map = host.emplace<MapKeeper>("map_keeper");
  const std::clock_t begin = std::clock();
  if (host.run() != 0) return Error{fmt::format("{}: the mapper failed", recording_file.string())};
  Mapped mapped{poses.live, poses.last, map.latest(), 0.0};
  mapped.cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return mapped;
}

Pose2 pose_of(const carmen::Pose& pose) {
  return {{pose.x, pose.y}, pose.theta};
}

/// How far a motion goes, a turn by a radian counted as half a metre.
double length_of(const Pose2& motion) {
  constexpr double kMetrePerRadian = 0.5;
  return motion.position.norm() + kMetrePerRadian * std::abs(motion.yaw);
}

/// Adds the poses of odometry between those of scans. What odometry is off by from one scan to the
/// next is spread over its way.
std::vector<TimedPose2> with_odometry_between(const std::vector<TimedPose2>& poses,
                                              const carmen::Log& log) {
  if (log.odometry.empty() || log.corrected || poses.size() != log.scans.size()) return poses;
  std::vector<TimedPose2> result;
  const std::vector<TimedPose2> odometry = timed_odometry(log);
  auto next = odometry.begin();
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    result.push_back(poses[i]);
    const Pose2 begin = pose_of(log.scans[i].robot_pose),
                end = pose_of(log.scans[i + 1].robot_pose);
    while (next != odometry.end() && next->t <= poses[i].t) ++next;
    std::vector<std::pair<TimedPose2, double>> on_the_way;  // odometry, and how far it has come
    Pose2 before = begin;
    double length = 0.0;
    for (; next != odometry.end() && next->t < poses[i + 1].t; ++next) {
      length += length_of(before.inverse() * next->pose);
      on_the_way.push_back({{next->t, begin.inverse() * next->pose}, length});
      before = next->pose;
    }
    length += length_of(before.inverse() * end);
    const Pose2 off = (poses[i].pose * (begin.inverse() * end)).inverse() * poses[i + 1].pose;
    for (const auto& [moved, so_far] : on_the_way) {
      const double share = length > 0.0 ? so_far / length : 0.0;
      result.push_back({moved.t, poses[i].pose * moved.pose * between({}, off, share)});
    }
  }
  if (!poses.empty()) result.push_back(poses.back());
  return result;
}

void append_rows(const std::string& name, const char* which, const RelationErrors& errors,
                 const Published* published, bool with_goal, std::vector<ExperimentRow>& rows) {
  const auto add = [&](const char* quantity, const char* unit, double value) {
    ExperimentRow& row = rows.emplace_back();
    row.quantity = fmt::format("{} {}, {}", name, quantity, which);
    row.unit = unit;
    row.values = {value};
  };
  constexpr double kDegrees = 180.0 / M_PI;
  add("translation", "m", errors.translation_mean);
  if (published != nullptr) {
    rows.back().reference = published->translation;
    rows.back().source = published->source;
    if (with_goal) rows.back().goal = published->goal;
  }
  add("translation std", "m", errors.translation_std);
  add("rotation", "deg", kDegrees * errors.rotation_mean);
  add("rotation std", "deg", kDegrees * errors.rotation_std);
}

/// A file of this process, gone with this object.
struct TemporaryRecording {
  fs::path file = fs::temp_directory_path() / fmt::format("swiftlet-slam-{}.mcap", getpid());
  ~TemporaryRecording() {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
};

Status score_log(const LaserLogFile& file, const ExperimentOptions& options,
                 std::vector<ExperimentRow>& rows) {
  const auto log = read_laser_log(file.file);
  if (!log.ok()) return log.error();
  if (log->scans.empty()) return Error{fmt::format("{}: holds no scan", file.file.string())};
  const TemporaryRecording recording;
  const auto mapped = map_log(*log, recording.file);
  if (!mapped.ok()) return mapped.error();
  if (!file.relations.empty()) {
    const auto relations = read_relations(file.relations);
    if (!relations.ok()) return relations.error();
    const auto* published =
        std::find_if(std::begin(kPublished), std::end(kPublished),
                     [&file](const Published& entry) { return file.name == entry.name; });
    if (published == std::end(kPublished)) published = nullptr;
    // The path of the last second may not have been told.
    std::vector<TimedPose2> last = mapped->last;
    for (std::size_t i = last.size(); i < mapped->live.size(); ++i) last.push_back(mapped->live[i]);
    append_rows(file.name, "final", relation_errors(with_odometry_between(last, *log), *relations),
                published, true, rows);
    append_rows(file.name, "live",
                relation_errors(with_odometry_between(mapped->live, *log), *relations), published,
                false, rows);
  }
  ExperimentRow speed;
  speed.quantity = fmt::format("{} speed, times real time on one core", file.name);
  speed.values = {to_seconds(log->scans.back().time - log->scans.front().time) / mapped->cpu_s};
  speed.goal = kLeastSpeed;
  speed.more_is_better = true;
  rows.push_back(speed);
  if (options.report.empty() || !mapped->map) return {};
  return save_map(*mapped->map, options.report / (file.name + "_map.png"));
}

}  // namespace

Result<ExperimentResult> run_slam_benchmark(const ExperimentOptions& options) {
  const std::vector<LaserLogFile> logs = find_laser_logs(options.data);
  if (logs.empty()) {
    return Error{fmt::format("{}: no X_scans.txt.gz and no X_raw.log.gz in it or below",
                             options.data.string())};
  }
  ExperimentResult result{"slam-benchmark", 1, {}};
  int done = 0;
  for (const LaserLogFile& log : logs) {
    options.progress(done++, static_cast<int>(logs.size()));
    if (const Status scored = score_log(log, options, result.rows); !scored.ok()) {
      return scored.error();
    }
  }
  options.progress(done, done);
  return result;
}

}  // namespace swiftlet
