// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "components/conversions.hpp"
#include "components/diagnostic_status.hpp"
#include "components/estimator/estimator_params.hpp"
#include "components/static_transforms.hpp"
#include "components/topics.hpp"
#include "estimation/consistency/consistency_window.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using Outcome = UpdateReport::Outcome;
using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

constexpr int kTfEvery = 5;  // odometry messages
constexpr Duration kReportEvery = 1s;

PoseMeasurement measurement_of(const geometry_msgs::msg::PoseWithCovarianceStamped& message) {
  PoseMeasurement measurement;
  measurement.p_WB = from_msg(message.pose().pose().position());
  measurement.q_WB = from_msg(message.pose().pose().orientation());
  measurement.covariance = Eigen::Map<const RowMajor6d>(message.pose().covariance().data());
  return measurement;
}

std::string text(const Eigen::Vector3d& v) {
  return fmt::format("{:.4g} {:.4g} {:.4g}", v.x(), v.y(), v.z());
}

/// Where the vehicle is: pose of the phone and IMU through the UKF of seed 000.
class Estimator : public Component {
 public:
  explicit Estimator(const ComponentContext& context)
      : Component(context), params_(read_estimator_params(parameters())), filter_(params_.filter) {
    odometry_ = advertise(topic::odometry);
    tf_ = advertise(topic::tf);
    diagnostics_ = advertise(topic::diagnostics);
    subscribe(topic::imu0, [this](const sensor_msgs::msg::Imu& imu) { on_imu(imu); });
    subscribe(topic::phone_pose,
              [this](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) { on_pose(pose); });
    every(kReportEvery, [this](Time now) { report(now); });
  }

 private:
  /// Poses since the last report.
  struct Counts {
    std::uint64_t used = 0, rejected = 0, refused = 0, restarts = 0;
  };

  void on_imu(const sensor_msgs::msg::Imu& imu) {
    if (!filter_.initialized()) return;
    const Status status = filter_.predict(from_msg(imu.header().stamp()), from_msg(imu));
    if (!status.ok()) {
      if (is_worth_a_line(++refused_samples_)) {
        log()->warn("IMU sample refused: {} ({} so far)", status.error().reason, refused_samples_);
      }
      return;
    }
    if (++samples_ % params_.odometry_every == 0) publish();
  }

  void on_pose(const geometry_msgs::msg::PoseWithCovarianceStamped& pose) {
    const Time time = from_msg(pose.header().stamp());
    const PoseMeasurement measurement = measurement_of(pose);
    if (!filter_.initialized()) {
      const Status status = filter_.initialize(time, measurement);
      if (!status.ok()) warn_of_pose(status.error().reason);
      return;
    }
    const UpdateReport report = filter_.update(time, measurement);
    count(report);
    if (report.outcome == Outcome::kReinitialized) {
      log()->warn("phone pose: {}", report.reason);
    } else if (!report.reason.empty()) {
      warn_of_pose(report.reason);
    }
  }

  void count(const UpdateReport& report) {
    switch (report.outcome) {
      case Outcome::kUsed:
        ++counts_.used;
        break;
      case Outcome::kRejected:
        ++counts_.rejected;
        break;
      case Outcome::kRefused:
        ++counts_.refused;
        break;
      case Outcome::kReinitialized:
        ++counts_.restarts;
        break;
    }
    // Also of those that the gate rejects, or the mean would be of the good ones alone.
    if (report.nis > 0.0) nis_.add(report.nis);
  }

  void warn_of_pose(const std::string& reason) {
    if (is_worth_a_line(++odd_poses_))
      log()->warn("phone pose: {} ({} so far)", reason, odd_poses_);
  }

  void publish() {
    const PoseImuUkf& ukf = filter_.present();
    auto message = to_odometry(ukf.time(), ukf.state());
    Eigen::Map<RowMajor6d>(message.pose().covariance().data()) = ukf.pose_covariance();
    // nav_msgs/Odometry has the velocity in the body.
    const Eigen::Matrix3d R_WB = ukf.state().q_WB.toRotationMatrix();
    Eigen::Map<RowMajor6d>(message.twist().covariance().data()).topLeftCorner<3, 3>() =
        R_WB.transpose() * ukf.covariance().block<3, 3>(3, 3) * R_WB;
    odometry_.publish(message);
    if (++published_ % kTfEvery == 0) publish_tf(message);
  }

  void publish_tf(const nav_msgs::msg::Odometry& odometry) {
    const RigidBodyState state = filter_.present().state();
    tf2_msgs::msg::TFMessage message;
    message.transforms({to_transform(filter_.present().time(), frame::kMap,
                                     odometry.child_frame_id(), {state.p_WB, state.q_WB})});
    tf_.publish(message);
  }

  /// Whether the filter believes itself rightly, for people.
  void report(Time now) {
    using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
    const PoseImuUkf& ukf = filter_.present();
    diagnostic_msgs::msg::DiagnosticStatus status;
    status.name("estimator");
    const bool consistent = nis_.count() == 0 || nis_.mean() < nis_.high();
    status.level(counts_.used > 0 && consistent ? OK : WARN);
    status.message(!filter_.initialized() ? "waits for the first pose"
                   : counts_.used == 0    ? "no pose used within the last second"
                   : !consistent          ? "poses are further off than the covariances say"
                                          : "");
    add_value(status, "nis_mean", nis_.mean());
    add_value(status, "nis_95_percent_low", nis_.low());
    add_value(status, "nis_95_percent_high", nis_.high());
    add_value(status, "poses_used_per_s", counts_.used);
    add_value(status, "poses_rejected_per_s", counts_.rejected);
    add_value(status, "poses_refused_per_s", counts_.refused);
    add_value(status, "restarts_per_s", counts_.restarts);
    add_value(status, "accelerometer_bias_m_s2", text(ukf.accelerometer_bias()));
    add_value(status, "gyro_bias_rad_s", text(ukf.gyro_bias()));
    add_value(status, "pose_drift_m", text(ukf.drift()));
    add_value(status, "covariance_repairs", ukf.covariance_repairs());
    diagnostic_msgs::msg::DiagnosticArray message;
    message.header(make_header(now, ""));
    message.status({status});
    diagnostics_.publish(message);
    counts_ = {};
    nis_.clear();
  }

  EstimatorParams params_;
  DelayedUkf filter_;
  std::int64_t samples_ = 0;
  std::uint64_t refused_samples_ = 0;
  std::uint64_t odd_poses_ = 0;  // refused, or reason for a restart
  Counts counts_;
  ConsistencyWindow nis_{6};
  std::int64_t published_ = 0;
  Publisher<nav_msgs::msg::Odometry> odometry_;
  Publisher<tf2_msgs::msg::TFMessage> tf_;
  Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
};

const RegisterComponent<Estimator> kRegistered{"estimator",
                                               "where the vehicle is, from phone pose and IMU"};

}  // namespace
}  // namespace swiftlet
