// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "components/topics.hpp"
#include "estimation/consistency/consistency_window.hpp"
#include "estimation/geometry/pose_history.hpp"

namespace swiftlet {

/// What a flight was worth, measured against the truth of the simulator.
struct FlightRecord {
  int contacts = 0;
  std::string last_contact;                                 ///< name of what was touched
  double min_clearance = 0.0;                               ///< of the hull in flight [m]
  Eigen::Vector3d closest_at = Eigen::Vector3d::Zero();     ///< where that was [m]
  Eigen::Vector3d position_rmse = Eigen::Vector3d::Zero();  ///< truth against reference [m]
  Eigen::Vector3d final_position = Eigen::Vector3d::Zero();
  /// Normalised square of the estimate's error of pose, mean of the flight: 6 where the covariance
  /// is as large as the errors. Zero where no estimate was heard.
  double pose_nees = 0.0;
  bool on_ground = true;                   ///< at the end
  std::vector<Eigen::Vector3d> flown;      ///< at 20 Hz, while armed [m]
  std::vector<double> flown_speed;         ///< of each [m/s]
  std::vector<Eigen::Vector3d> reference;  ///< at 20 Hz, while armed [m]
};

/// Of the way that was flown [m].
double length_flown(const FlightRecord& record);

/// Watches a simulated flight and keeps the score. It takes part in nothing, and says on
/// `diagnostics` how good the estimate's covariance is.
class Referee : public Component {
 public:
  explicit Referee(const ComponentContext& context);

  FlightRecord record() const;

 private:
  void on_truth(const swiftlet_msgs::msg::SimTruth& truth);
  void on_setpoint(const swiftlet_msgs::msg::Setpoint& setpoint);
  void on_odometry(const nav_msgs::msg::Odometry& odometry);
  void report(Time now);
  void score();

  PoseHistory truth_;
  swiftlet_msgs::msg::SimTruth last_truth_;
  std::uint8_t mode_ = 0;
  struct Reference {
    Time time;
    Eigen::Vector3d position;
  };
  std::deque<Reference> waiting_;                  // for the truth of their time
  std::deque<nav_msgs::msg::Odometry> estimates_;  // likewise
  ConsistencyWindow nees_{6};                      // of the flight
  ConsistencyWindow recent_nees_{6};               // since the last report
  Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
  Eigen::Vector3d squared_error_ = Eigen::Vector3d::Zero();
  std::int64_t scored_ = 0;
  std::int64_t truths_ = 0;
  FlightRecord record_;
};

}  // namespace swiftlet
