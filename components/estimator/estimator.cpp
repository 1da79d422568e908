// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/conversions.hpp"
#include "components/static_transforms.hpp"
#include "components/topics.hpp"
#include "estimation/ukf/pose_imu_ukf.hpp"

namespace swiftlet {
namespace {

constexpr int kTfEvery = 5;  // odometry messages

struct Params {
  PoseImuUkf::Params ukf;
  int odometry_every = 4;  ///< IMU samples: 250 Hz of a 1 kHz IMU
};

Params read_params(const Config& config) {
  Params params;
  config.read("gyro_noise", params.ukf.gyro_noise, kPositive);
  config.read("accelerometer_noise", params.ukf.accelerometer_noise, kPositive);
  config.read("bias_random_walk", params.ukf.bias_random_walk, kPositive);
  config.read("initial_velocity_sigma", params.ukf.initial_velocity_sigma, kPositive);
  config.read("initial_accelerometer_bias_sigma", params.ukf.initial_accelerometer_bias_sigma,
              kPositive);
  config.read("gate", params.ukf.gate, kPositive);
  config.read("reset_count", params.ukf.reset_count, {1, 1000});
  config.read("reset_after", params.ukf.reset_after, kPositive);
  config.read("odometry_every", params.odometry_every, {1, 1000});
  return params;
}

PoseMeasurement measurement_of(const geometry_msgs::msg::PoseWithCovarianceStamped& message) {
  PoseMeasurement measurement;
  measurement.p_WB = from_msg(message.pose().pose().position());
  measurement.q_WB = from_msg(message.pose().pose().orientation());
  using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  measurement.covariance = Eigen::Map<const RowMajor>(message.pose().covariance().data());
  return measurement;
}

/// Where the vehicle is: pose of the phone and IMU through the UKF of seed 000.
class Estimator : public Component {
 public:
  explicit Estimator(const ComponentContext& context)
      : Component(context), params_(read_params(parameters())), ukf_(params_.ukf) {
    odometry_ = advertise(topic::odometry);
    tf_ = advertise(topic::tf);
    subscribe(topic::imu0, [this](const sensor_msgs::msg::Imu& imu) { on_imu(imu); });
    subscribe(topic::phone_pose,
              [this](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) { on_pose(pose); });
  }

 private:
  void on_imu(const sensor_msgs::msg::Imu& imu) {
    if (!ukf_.initialized()) return;
    const Status status = ukf_.predict(from_msg(imu.header().stamp()), from_msg(imu));
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
    if (!ukf_.initialized()) {
      const Status status = ukf_.initialize(time, measurement);
      if (!status.ok()) warn_of_pose(status.error().reason);
      return;
    }
    const UpdateReport report = ukf_.update(time, measurement);
    if (report.outcome == UpdateReport::Outcome::kReinitialized) {
      log()->warn("phone pose: {}", report.reason);
    } else if (!report.reason.empty()) {
      warn_of_pose(report.reason);
    }
  }

  void warn_of_pose(const std::string& reason) {
    if (is_worth_a_line(++odd_poses_))
      log()->warn("phone pose: {} ({} so far)", reason, odd_poses_);
  }

  void publish() {
    auto message = to_odometry(ukf_.time(), ukf_.state());
    using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(message.pose().covariance().data()) = ukf_.pose_covariance();
    // nav_msgs/Odometry has the velocity in the body.
    const Eigen::Matrix3d R_WB = ukf_.state().q_WB.toRotationMatrix();
    Eigen::Map<RowMajor>(message.twist().covariance().data()).topLeftCorner<3, 3>() =
        R_WB.transpose() * ukf_.covariance().block<3, 3>(3, 3) * R_WB;
    odometry_.publish(message);
    if (++published_ % kTfEvery == 0) publish_tf(message);
  }

  void publish_tf(const nav_msgs::msg::Odometry& odometry) {
    tf2_msgs::msg::TFMessage message;
    message.transforms({to_transform(ukf_.time(), frame::kMap, odometry.child_frame_id(),
                                     {ukf_.state().p_WB, ukf_.state().q_WB})});
    tf_.publish(message);
  }

  Params params_;
  PoseImuUkf ukf_;
  std::int64_t samples_ = 0;
  std::uint64_t refused_samples_ = 0;
  std::uint64_t odd_poses_ = 0;  // refused, or reason for a restart
  std::int64_t published_ = 0;
  Publisher<nav_msgs::msg::Odometry> odometry_;
  Publisher<tf2_msgs::msg::TFMessage> tf_;
};

const RegisterComponent<Estimator> kRegistered{"estimator",
                                               "where the vehicle is, from phone pose and IMU"};

}  // namespace
}  // namespace swiftlet
