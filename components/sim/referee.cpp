// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/referee.hpp"

#include <Eigen/Cholesky>
#include <limits>

#include "components/conversions.hpp"
#include "components/diagnostic_status.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;

constexpr int kTrackEvery = 5;  // of the truth at 100 Hz
constexpr Duration kReportEvery = 1s;

double pose_nees(const PoseHistory::Pose& truth, const nav_msgs::msg::Odometry& odometry) {
  using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  const RigidBodyState estimate = from_msg(odometry);
  Eigen::Matrix<double, 6, 1> error;
  error << truth.position - estimate.p_WB, log_so3(truth.attitude * estimate.q_WB.conjugate());
  const RowMajor6d covariance = Eigen::Map<const RowMajor6d>(odometry.pose().covariance().data());
  return error.dot(covariance.ldlt().solve(error));
}

}  // namespace

Referee::Referee(const ComponentContext& context) : Component(context), truth_(2s) {
  last_truth_.minimum_clearance(std::numeric_limits<double>::infinity());
  subscribe(topic::sim_truth,
            [this](const swiftlet_msgs::msg::SimTruth& truth) { on_truth(truth); });
  subscribe(topic::setpoint,
            [this](const swiftlet_msgs::msg::Setpoint& setpoint) { on_setpoint(setpoint); });
  subscribe(topic::vehicle_status,
            [this](const swiftlet_msgs::msg::VehicleStatus& status) { mode_ = status.mode(); });
  subscribe(topic::odometry,
            [this](const nav_msgs::msg::Odometry& odometry) { on_odometry(odometry); });
  diagnostics_ = advertise(topic::diagnostics);
  every(kReportEvery, [this](Time now) { report(now); });
}

void Referee::on_odometry(const nav_msgs::msg::Odometry& odometry) {
  if (mode_ == mode::GROUNDED) return;
  estimates_.push_back(odometry);
  score();
}

void Referee::report(Time now) {
  using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name("referee");
  status.level(OK);
  status.message(recent_nees_.count() == 0 ? "no estimate in flight" : "");
  add_value(status, "pose_nees_mean", recent_nees_.mean());
  // Errors last longer than a second, so that their mean is worth little more than one of them.
  add_value(status, "pose_nees_95_percent_low", chi_square_quantile(6, -1.96));
  add_value(status, "pose_nees_95_percent_high", chi_square_quantile(6, 1.96));
  diagnostic_msgs::msg::DiagnosticArray message;
  message.header(make_header(now, ""));
  message.status({status});
  diagnostics_.publish(message);
  recent_nees_.clear();
}

void Referee::on_truth(const swiftlet_msgs::msg::SimTruth& truth) {
  const Eigen::Vector3d position = from_msg(truth.pose().position());
  if (truth.minimum_clearance() < last_truth_.minimum_clearance()) record_.closest_at = position;
  last_truth_ = truth;
  truth_.add(from_msg(truth.header().stamp()), {position, from_msg(truth.pose().orientation())});
  if (mode_ != mode::GROUNDED && ++truths_ % kTrackEvery == 0) {
    record_.flown.push_back(position);
    record_.flown_speed.push_back(from_msg(truth.twist().linear()).norm());
  }
  score();
}

void Referee::on_setpoint(const swiftlet_msgs::msg::Setpoint& setpoint) {
  const bool tracked = setpoint.kind() == swiftlet_msgs::msg::Setpoint_Constants::TRACK;
  // A landing aims below the ground, on purpose.
  if (!tracked || mode_ == mode::LAND) return;
  waiting_.push_back({from_msg(setpoint.header().stamp()), from_msg(setpoint.position())});
  score();
}

void Referee::score() {
  while (!waiting_.empty() && !truth_.empty() && waiting_.front().time <= truth_.newest()) {
    if (const auto pose = truth_.at(waiting_.front().time)) {
      squared_error_ += (pose->position - waiting_.front().position).cwiseAbs2();
      if (++scored_ % kTrackEvery == 0) record_.reference.push_back(waiting_.front().position);
    }
    waiting_.pop_front();
  }
  const auto time_of = [](const nav_msgs::msg::Odometry& odometry) {
    return from_msg(odometry.header().stamp());
  };
  while (!estimates_.empty() && !truth_.empty() && time_of(estimates_.front()) <= truth_.newest()) {
    if (const auto truth = truth_.at(time_of(estimates_.front()))) {
      const double nees = pose_nees(*truth, estimates_.front());
      nees_.add(nees);
      recent_nees_.add(nees);
    }
    estimates_.pop_front();
  }
}

double length_flown(const FlightRecord& record) {
  double length = 0.0;
  for (std::size_t i = 1; i < record.flown.size(); ++i) {
    length += (record.flown[i] - record.flown[i - 1]).norm();
  }
  return length;
}

FlightRecord Referee::record() const {
  FlightRecord record = record_;
  record.contacts = static_cast<int>(last_truth_.contacts());
  record.last_contact = last_truth_.last_contact();
  record.pose_nees = nees_.mean();
  record.min_clearance = last_truth_.minimum_clearance();
  if (scored_ > 0) {
    record.position_rmse = (squared_error_ / static_cast<double>(scored_)).cwiseSqrt();
  }
  record.final_position = from_msg(last_truth_.pose().position());
  record.on_ground = last_truth_.on_ground();
  return record;
}

}  // namespace swiftlet
