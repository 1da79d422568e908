// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/referee.hpp"

#include <limits>

#include "components/conversions.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;

constexpr int kTrackEvery = 5;  // of the truth at 100 Hz

}  // namespace

Referee::Referee(const ComponentContext& context) : Component(context), truth_(2s) {
  last_truth_.minimum_clearance(std::numeric_limits<double>::infinity());
  subscribe(topic::sim_truth,
            [this](const swiftlet_msgs::msg::SimTruth& truth) { on_truth(truth); });
  subscribe(topic::setpoint,
            [this](const swiftlet_msgs::msg::Setpoint& setpoint) { on_setpoint(setpoint); });
  subscribe(topic::vehicle_status,
            [this](const swiftlet_msgs::msg::VehicleStatus& status) { mode_ = status.mode(); });
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
}

FlightRecord Referee::record() const {
  FlightRecord record = record_;
  record.contacts = static_cast<int>(last_truth_.contacts());
  record.last_contact = last_truth_.last_contact();
  record.min_clearance = last_truth_.minimum_clearance();
  if (scored_ > 0) {
    record.position_rmse = (squared_error_ / static_cast<double>(scored_)).cwiseSqrt();
  }
  record.final_position = from_msg(last_truth_.pose().position());
  record.on_ground = last_truth_.on_ground();
  return record;
}

}  // namespace swiftlet
