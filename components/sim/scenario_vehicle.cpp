// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/scenario_vehicle.hpp"

#include "components/vehicle_model.hpp"

#include <cmath>

namespace swiftlet {

namespace {

constexpr Range kProbability{0.0, 1.0};
constexpr Range kRate{0.0, 1000.0};  // [Hz]; the simulator steps at 1 kHz, zero switches off

void read_mount(const Config& sensor, Mount& mount) {
  const Config config = sensor.child("mount");
  config.read("position", mount.position);
  if (config.has("roll_pitch_yaw")) {
    Eigen::Vector3d angles = Eigen::Vector3d::Zero();
    config.read("roll_pitch_yaw", angles);
    mount.attitude = Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
  }
}

void read_triad(const Config& config, InertialTriad& triad) {
  config.read("noise_density", triad.noise_density, kNotNegative);
  config.read("bias", triad.bias, kNotNegative);
  config.read("bias_random_walk", triad.bias_random_walk, kNotNegative);
  config.read("range", triad.range, kNotNegative);
  config.read("resolution", triad.resolution, kNotNegative);
}

void read_imu(const Config& config, ImuSensor::Params& imu) {
  config.read("rate_hz", imu.rate_hz, kRate);
  read_triad(config.child("gyroscope"), imu.gyroscope);
  read_triad(config.child("accelerometer"), imu.accelerometer);
  read_mount(config, imu.mount);
}

void read_phone(const Config& config, PhonePoseSensor::Params& phone) {
  config.read("rate_hz", phone.rate_hz, kRate);
  config.read("position_rmse", phone.position_rmse, kNotNegative);
  config.read("drift_fraction", phone.drift_fraction, kProbability);
  config.read("drift_time_constant", phone.drift_time_constant, kNotNegative);
  config.read("tilt_stddev", phone.tilt_stddev, kNotNegative);
  config.read("yaw_stddev", phone.yaw_stddev, kNotNegative);
  config.read("drop_probability", phone.drop_probability, kProbability);
  config.read("latency_ms", phone.latency_ms, {0.0, 10000.0});
  read_mount(config, phone.mount);
}

void read_lidar(const Config& config, Lidar2d::Params& lidar) {
  config.read("rate_hz", lidar.rate_hz, kRate);
  config.read("beams", lidar.beams, {1, 100000});
  config.read("range_min", lidar.range_min, kNotNegative);
  config.read("range_max", lidar.range_max, kPositive);
  if (lidar.range_max <= lidar.range_min) {
    config.fail("range_max", "'range_max' must be more than 'range_min'");
  }
  config.read("noise_stddev", lidar.noise_stddev, kNotNegative);
  config.read("resolution", lidar.resolution, kNotNegative);
  config.read("dropout_probability", lidar.dropout_probability, kProbability);
  read_mount(config, lidar.mount);
}

void read_sonar(const Config& config, Sonar::Params& sonar) {
  config.read("rate_hz", sonar.rate_hz, kRate);
  config.read("range_min", sonar.range_min, kNotNegative);
  config.read("range_max", sonar.range_max, kPositive);
  if (sonar.range_max <= sonar.range_min) {
    config.fail("range_max", "'range_max' must be more than 'range_min'");
  }
  config.read("cone_half_angle", sonar.cone_half_angle, {0.0, 1.5});
  config.read("noise_stddev", sonar.noise_stddev, kNotNegative);
  config.read("resolution", sonar.resolution, kNotNegative);
  config.read("dropout_probability", sonar.dropout_probability, kProbability);
  read_mount(config, sonar.mount);
}

void read_battery(const Config& config, Battery::Params& battery) {
  config.read("rate_hz", battery.rate_hz, kRate);
  config.read("cells", battery.cells, {1, 24});
  config.read("capacity_mah", battery.capacity_mah, kPositive);
  config.read("charge_at_start", battery.charge_at_start, kProbability);
  config.read("internal_resistance", battery.internal_resistance, kNotNegative);
  config.read("propeller_radius", battery.propeller_radius, kPositive);
  config.read("efficiency", battery.efficiency, {0.01, 1.0});
  config.read("electronics_power", battery.electronics_power, kNotNegative);
  config.read("voltage_noise", battery.voltage_noise, kNotNegative);
  config.read("current_noise", battery.current_noise, kNotNegative);
}

void read_gps(const Config& config, GpsSensor::Params& gps) {
  config.read("rate_hz", gps.rate_hz, kRate);
  config.read("horizontal_stddev", gps.horizontal_stddev, kNotNegative);
  config.read("vertical_stddev", gps.vertical_stddev, kNotNegative);
}

}  // namespace

void read_vehicle(const Config& config, Quadrotor::Params& params) {
  read_vehicle_model(config, params.model);
  config.read("linear_drag", params.linear_drag, kNotNegative);
  config.read("quadratic_drag", params.quadratic_drag, kNotNegative);
  config.read("body_radius", params.hull.radius, kPositive);
  config.read("leg_height", params.ground.leg_height, kPositive);
  config.read("leg_spread", params.ground.leg_spread, kPositive);
  config.read("mast_height", params.ground.mast_height, kPositive);
  config.read("friction", params.ground.friction, kNotNegative);
  params.hull.friction = params.ground.friction;
}

void read_sensors(const Config& config, Scenario::Sensors& sensors) {
  read_imu(config.child("imu0"), sensors.imu0);
  read_imu(config.child("imu1"), sensors.imu1);
  read_imu(config.child("imu2"), sensors.imu2);
  read_phone(config.child("phone"), sensors.phone);
  read_lidar(config.child("lidar"), sensors.lidar);
  read_sonar(config.child("sonar"), sensors.sonar);
  read_battery(config.child("battery"), sensors.battery);
  read_gps(config.child("gps"), sensors.gps);
}

void read_claw(const Config& config, ClawServo::Params& claw) {
  config.read("pulse_open_us", claw.pulse_open_us, {400.0, 2600.0});
  config.read("pulse_closed_us", claw.pulse_closed_us, {400.0, 2600.0});
  if (claw.pulse_open_us == claw.pulse_closed_us) {
    config.fail("pulse_closed_us", "'pulse_closed_us' must be another than 'pulse_open_us'");
  }
  config.read("max_speed_us", claw.max_speed_us, kPositive);
  config.read("time_constant", claw.time_constant, kPositive);
  config.read("object", claw.object);
  config.read("object_opening", claw.object_opening, kProbability);
  config.read("jammed", claw.jammed);
  config.read("start_opening", claw.start_opening, kProbability);
  if (claw.object && claw.start_opening < claw.object_opening) {
    config.fail("start_opening",
                "the object is between the jaws, which cannot be narrower: raise "
                "'start_opening' or lower 'object_opening'");
  }
}

}  // namespace swiftlet
