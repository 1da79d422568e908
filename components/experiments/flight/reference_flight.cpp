// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/flight/reference_flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "components/conversions.hpp"
#include "components/runtime/host.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace setpoint_kind = swiftlet_msgs::msg::Setpoint_Constants;
using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

constexpr Duration kSetpointEvery = 10ms;
/// On the ground with the rotors off, until the filter has settled.
constexpr double kRest_s = 3.0;

/// Says what to do, and ends the run when there is no more.
class ReferencePilot : public Component {
 public:
  ReferencePilot(const ComponentContext& context, const ReferenceFlight& flight)
      : Component(context), flight_(flight), setpoint_(advertise(topic::setpoint)) {
    every(kSetpointEvery, [this](Time now) { say(now); });
  }

  /// When the take-off began.
  Time begin() const { return begin_.value_or(Time{}) + from_seconds(kRest_s); }

 private:
  void say(Time now) {
    if (!begin_) begin_ = now;
    const double t = to_seconds(now - begin());
    if (t > flight_.duration_s) stop(0);
    swiftlet_msgs::msg::Setpoint message;
    message.header(make_header(now, frame::kMap));
    message.kind(t < 0.0 ? setpoint_kind::MOTORS_OFF : setpoint_kind::TRACK);
    set_reference(flight_.reference(std::max(t, 0.0)), message);
    setpoint_.publish(message);
  }

  const ReferenceFlight& flight_;
  std::optional<Time> begin_;
  Publisher<swiftlet_msgs::msg::Setpoint> setpoint_;
};

/// Keeps what is said of one thing over time, to be asked for between.
template <class T>
class Samples {
 public:
  void add(Time time, const T& value) { samples_.emplace_back(time, value); }
  const std::vector<std::pair<Time, T>>& all() const { return samples_; }
  bool covers(Time time) const {
    return !samples_.empty() && samples_.front().first <= time && time <= samples_.back().first;
  }
  /// The two neighbours of a time that is covered, and the share of the later.
  std::tuple<const T*, const T*, double> around(Time time) const {
    const auto after = std::lower_bound(
        samples_.begin(), samples_.end(), time,
        [](const std::pair<Time, T>& sample, Time at) { return sample.first < at; });
    if (after->first == time) return {&after->second, &after->second, 1.0};
    const auto before = std::prev(after);
    const double share =
        to_seconds(time - before->first) / to_seconds(after->first - before->first);
    return {&before->second, &after->second, share};
  }

 private:
  std::vector<std::pair<Time, T>> samples_;
};

RigidBodyState between(const RigidBodyState& a, const RigidBodyState& b, double share) {
  RigidBodyState state;
  state.p_WB = a.p_WB + share * (b.p_WB - a.p_WB);
  state.q_WB = a.q_WB.slerp(share, b.q_WB);
  state.v_WB_W = a.v_WB_W + share * (b.v_WB_W - a.v_WB_W);
  state.w_WB_B = a.w_WB_B + share * (b.w_WB_B - a.w_WB_B);
  return state;
}

/// Notes all that is said of a flight.
class FlightLog : public Component {
 public:
  explicit FlightLog(const ComponentContext& context) : Component(context) {
    subscribe(topic::sim_truth, [this](const swiftlet_msgs::msg::SimTruth& truth) {
      if (truth.contacts() > 0 && touched_.empty()) touched_ = truth.last_contact();
      truth_.add(from_msg(truth.header().stamp()),
                 {from_msg(truth.pose().position()), from_msg(truth.pose().orientation()),
                  from_msg(truth.twist().linear()), from_msg(truth.twist().angular())});
    });
    subscribe(topic::odometry, [this](const nav_msgs::msg::Odometry& odometry) {
      Estimate estimate;
      estimate.state = from_msg(odometry);
      estimate.pose_covariance = Eigen::Map<const RowMajor6d>(odometry.pose().covariance().data());
      estimate.velocity_covariance_B =
          Eigen::Map<const RowMajor6d>(odometry.twist().covariance().data()).topLeftCorner<3, 3>();
      estimate_.add(from_msg(odometry.header().stamp()), estimate);
    });
    subscribe(topic::phone_pose, [this](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) {
      phone_.add(from_msg(pose.header().stamp()), {from_msg(pose.pose().pose().position()),
                                                   from_msg(pose.pose().pose().orientation())});
    });
  }

  const std::string& touched() const { return touched_; }

  /// All from `begin` on, brought to the times of the truth.
  FlightSeries series(Time begin, const ReferenceFlight& flight) const {
    FlightSeries series;
    for (const auto& [time, truth] : truth_.all()) {
      if (time < begin || !estimate_.covers(time)) continue;
      const auto [before, after, share] = estimate_.around(time);
      FlightMoment moment;
      moment.t = to_seconds(time - begin);
      moment.truth = truth;
      moment.estimate = between(before->state, after->state, share);
      moment.pose_covariance = after->pose_covariance;
      moment.velocity_covariance_B = after->velocity_covariance_B;
      moment.desired = flight.reference(moment.t);
      series.moments.push_back(moment);
    }
    for (const auto& [time, pose] : phone_.all()) {
      if (time < begin || !truth_.covers(time)) continue;
      const auto [before, after, share] = truth_.around(time);
      series.phone.push_back({to_seconds(time - begin), between(*before, *after, share),
                              pose.position, pose.attitude});
    }
    return series;
  }

 private:
  struct Estimate {
    RigidBodyState state;
    Eigen::Matrix<double, 6, 6> pose_covariance;
    Eigen::Matrix3d velocity_covariance_B;
  };
  struct Pose {
    Eigen::Vector3d position;
    Eigen::Quaterniond attitude;
  };

  Samples<RigidBodyState> truth_;
  Samples<Estimate> estimate_;
  Samples<Pose> phone_;
  std::string touched_;
};

}  // namespace

Result<FlightSeries> fly(const ReferenceFlight& flight) {
  Config parameters = flight.parameters;
  parameters.set("sim.scenario", flight.scenario.string());
  parameters.set("sim.seed", std::to_string(flight.seed));
  HostOptions options;
  options.participant.name = "experiment";
  options.lockstep = true;
  Host host(options);
  for (const char* name : {"sim", "estimator", "flight_controller"}) {
    host.add(name, parameters.child(name));
  }
  auto& pilot = host.emplace<ReferencePilot>("reference_pilot", flight);
  auto& log = host.emplace<FlightLog>("flight_log");
  if (host.run() != 0) return Error{"the flight was ended by the error above, or by a signal"};
  if (!log.touched().empty()) {
    return Error{fmt::format("seed {}: the vehicle touched '{}'", flight.seed, log.touched())};
  }
  FlightSeries series = log.series(pilot.begin(), flight);
  if (series.moments.empty() || series.moments.back().t < flight.duration_s - 0.1) {
    return Error{fmt::format("seed {}: the flight ended after {:.1f} s of {:.1f}", flight.seed,
                             series.moments.empty() ? 0.0 : series.moments.back().t,
                             flight.duration_s)};
  }
  return series;
}

}  // namespace swiftlet
