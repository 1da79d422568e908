// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "components/conversions.hpp"
#include "components/runtime/supervision/staleness.hpp"
#include "components/sim/simulation.hpp"
#include "components/static_transforms.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// An ESC that hears nothing for so long stops its motor.
constexpr Duration kMotorTimeout = 100ms;
constexpr int kTruthEvery = 10;  // steps: 100 Hz

Scenario scenario_of(const Config& parameters) {
  std::string file;
  parameters.require("scenario", file);
  Scenario scenario = Scenario::load(file);
  int seed = static_cast<int>(scenario.seed);
  parameters.read("seed", seed, kNotNegative);
  scenario.seed = static_cast<std::uint64_t>(seed);
  bool phone = true;
  parameters.read("phone", phone);
  if (!phone) scenario.sensors.phone.rate_hz = 0.0;
  return scenario;
}

/// The simulated vehicle in its world, in place of sensor drivers and motor controllers.
class SimComponent : public Component {
 public:
  explicit SimComponent(const ComponentContext& context)
      : Component(context), simulation_(scenario_of(parameters())), motor_watch_(kMotorTimeout, 1) {
    imu_[0] = advertise(topic::imu0);
    imu_[1] = advertise(topic::imu1);
    imu_[2] = advertise(topic::imu2);
    // Without a simulated phone the topic is that of a real one, through phone_link.
    if (simulation_.scenario().sensors.phone.rate_hz > 0.0) phone_ = advertise(topic::phone_pose);
    scan_ = advertise(topic::scan);
    range_ = advertise(topic::range_down);
    battery_ = advertise(topic::battery);
    if (simulation_.world().local_origin()) gps_ = advertise(topic::gps_fix);
    truth_ = advertise(topic::sim_truth);
    clock_ = advertise(topic::clock);
    tf_static_ = advertise(topic::tf_static);
    subscribe(topic::motors, [this](const swiftlet_msgs::msg::MotorCommand& command) {
      motor_watch_.heard(now());
      std::copy(command.thrust().begin(), command.thrust().end(), thrust_.data());
      armed_ = command.armed();
      if (!armed_) thrust_.setZero();
    });
    every(Simulation::kStep, [this](Time now) { catch_up(now); });
  }

 private:
  /// Simulates up to `now`; in live operation that can be several steps.
  void catch_up(Time now) {
    if (!begin_) begin_ = now - Simulation::kStep;
    if (motor_watch_.stale(now)) stop_motors();
    if (active() && !std::exchange(mounts_told_, true)) publish_mounts(now);
    while (*begin_ + simulation_.time().time_since_epoch() + Simulation::kStep <= now) {
      publish(simulation_.step(Simulation::kStep, thrust_));
    }
  }

  void stop_motors() {
    thrust_.setZero();
    if (std::exchange(armed_, false)) {
      log()->error("no motor commands for {:.2f} s: motors stopped", to_seconds(kMotorTimeout));
    }
  }

  /// The simulation counts from zero, the run from wherever its clock began.
  Time run_time(Time simulated) const { return *begin_ + simulated.time_since_epoch(); }

  /// Where the sensors sit on the body: once, for all who come later, too.
  void publish_mounts(Time now) {
    // A Range is along the x axis of its frame; the sonar looks along its own -z.
    const Eigen::Quaterniond x_down(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()));
    const Scenario::Sensors& sensors = simulation_.scenario().sensors;
    tf2_msgs::msg::TFMessage message;
    const auto add = [&](const char* frame, const Mount& mount) {
      message.transforms().push_back(
          to_transform(now, frame::kBody, frame, {mount.position, mount.attitude}));
    };
    add(frame::kLaser, sensors.lidar.mount);
    add(frame::kImu[0], sensors.imu0.mount);
    add(frame::kImu[1], sensors.imu1.mount);
    add(frame::kImu[2], sensors.imu2.mount);
    add(frame::kRangeDown, {sensors.sonar.mount.position, sensors.sonar.mount.attitude * x_down});
    tf_static_.publish(message);
  }

  void publish(const SensorReadings& readings) {
    if (++steps_ % kTruthEvery == 0) publish_truth();
    if (readings.battery != nullptr) publish(*readings.battery);
    if (readings.range_down != nullptr) publish(*readings.range_down);
    if (readings.phone != nullptr) publish(*readings.phone);
    if (readings.gps != nullptr) publish(*readings.gps);
    if (readings.scan != nullptr) publish(*readings.scan);
    for (std::size_t i = 0; i < imu_.size(); ++i) {
      if (readings.imu[i] != nullptr) publish(i, *readings.imu[i]);
    }
  }

  void publish_truth() {
    const VehicleTruth& truth = simulation_.truth();
    swiftlet_msgs::msg::SimTruth message;
    message.header(make_header(run_time(truth.time), frame::kMap));
    message.pose(to_pose(truth.body.p_WB, truth.body.q_WB));
    message.twist().linear(to_vector3(truth.body.v_WB_W));
    message.twist().angular(to_vector3(truth.body.w_WB_B));
    message.on_ground(truth.on_ground);
    message.contacts(static_cast<std::uint32_t>(simulation_.contacts()));
    if (!simulation_.collisions().empty()) {
      message.last_contact(simulation_.collisions().back().model);
    }
    message.minimum_clearance(simulation_.min_clearance());
    truth_.publish(message);
    rosgraph_msgs::msg::Clock clock;
    clock.clock(message.header().stamp());
    clock_.publish(clock);
  }

  void publish(std::size_t index, const ImuReading& reading) {
    auto& message = imu_message_;
    message.header(make_header(run_time(reading.time), frame::kImu[index]));
    message.orientation_covariance()[0] = -1.0;  // by its definition: there is no orientation
    message.angular_velocity(to_vector3(reading.sample.angular_velocity));
    message.linear_acceleration(to_vector3(reading.sample.specific_force));
    imu_[index].publish(message);
  }

  void publish(const PhonePoseReading& reading) {
    geometry_msgs::msg::PoseWithCovarianceStamped message;
    message.header(make_header(run_time(reading.time), frame::kMap));
    message.pose().pose(to_pose(reading.position, reading.attitude));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double position = reading.position_stddev[axis];
      const double attitude = reading.attitude_stddev[axis];
      message.pose().covariance()[7 * i] = position * position;
      message.pose().covariance()[7 * (i + 3)] = attitude * attitude;
    }
    phone_.publish(message);
  }

  void publish(const GpsReading& reading) {
    using namespace sensor_msgs::msg;
    NavSatFix message;
    message.header(make_header(run_time(reading.time), frame::kBody));
    message.status().status(NavSatStatus_Constants::STATUS_FIX);
    message.status().service(NavSatStatus_Constants::SERVICE_GPS);
    message.latitude(reading.position.latitude);
    message.longitude(reading.position.longitude);
    message.altitude(reading.position.altitude);
    const double horizontal = reading.horizontal_stddev * reading.horizontal_stddev;
    message.position_covariance()[0] = horizontal;
    message.position_covariance()[4] = horizontal;
    message.position_covariance()[8] = reading.vertical_stddev * reading.vertical_stddev;
    message.position_covariance_type(NavSatFix_Constants::COVARIANCE_TYPE_DIAGONAL_KNOWN);
    gps_.publish(message);
  }

  void publish(const LaserScanReading& reading) {
    sensor_msgs::msg::LaserScan message;
    message.header(make_header(run_time(reading.time), frame::kLaser));
    message.angle_min(static_cast<float>(reading.angle_min));
    message.angle_increment(static_cast<float>(reading.angle_increment));
    message.angle_max(
        static_cast<float>(reading.angle_min + reading.angle_increment *
                                                   static_cast<double>(reading.ranges.size() - 1)));
    message.range_min(static_cast<float>(reading.range_min));
    message.range_max(static_cast<float>(reading.range_max));
    message.ranges(reading.ranges);
    scan_.publish(message);
  }

  void publish(const RangeReading& reading) {
    sensor_msgs::msg::Range message;
    message.header(make_header(run_time(reading.time), frame::kRangeDown));
    message.radiation_type(sensor_msgs::msg::Range_Constants::ULTRASOUND);
    message.field_of_view(static_cast<float>(reading.field_of_view));
    message.min_range(static_cast<float>(reading.range_min));
    message.max_range(static_cast<float>(reading.range_max));
    message.range(static_cast<float>(reading.range));
    range_.publish(message);
  }

  void publish(const BatteryReading& reading) {
    using namespace sensor_msgs::msg::BatteryState_Constants;
    sensor_msgs::msg::BatteryState message;
    message.header(make_header(run_time(reading.time), frame::kBody));
    message.voltage(static_cast<float>(reading.voltage));
    message.temperature(
        std::numeric_limits<float>::quiet_NaN());           // by its definition: not measured
    message.current(static_cast<float>(-reading.current));  // negative when discharging
    message.charge(static_cast<float>(reading.charge));
    message.capacity(std::numeric_limits<float>::quiet_NaN());
    message.design_capacity(
        static_cast<float>(simulation_.scenario().sensors.battery.capacity_mah / 1000.0));
    message.percentage(static_cast<float>(reading.percentage));
    message.power_supply_status(POWER_SUPPLY_STATUS_DISCHARGING);
    message.power_supply_health(POWER_SUPPLY_HEALTH_GOOD);
    message.power_supply_technology(POWER_SUPPLY_TECHNOLOGY_LIPO);
    message.present(true);
    battery_.publish(message);
  }

  Simulation simulation_;
  std::optional<Time> begin_;  // of the simulation, on the clock of the run
  std::int64_t steps_ = 0;
  bool mounts_told_ = false;
  Eigen::Vector4d thrust_ = Eigen::Vector4d::Zero();
  bool armed_ = false;
  StalenessWatch motor_watch_;
  std::array<Publisher<sensor_msgs::msg::Imu>, 3> imu_;
  sensor_msgs::msg::Imu imu_message_;
  Publisher<geometry_msgs::msg::PoseWithCovarianceStamped> phone_;
  Publisher<sensor_msgs::msg::LaserScan> scan_;
  Publisher<sensor_msgs::msg::Range> range_;
  Publisher<sensor_msgs::msg::BatteryState> battery_;
  Publisher<sensor_msgs::msg::NavSatFix> gps_;
  Publisher<swiftlet_msgs::msg::SimTruth> truth_;
  Publisher<rosgraph_msgs::msg::Clock> clock_;
  Publisher<tf2_msgs::msg::TFMessage> tf_static_;
};

const RegisterComponent<SimComponent> kRegistered{"sim",
                                                  "a simulated vehicle in a simulated world"};

}  // namespace
}  // namespace swiftlet
