// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/imu.hpp"

#include "estimation/geometry/so3.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;

VehicleTruth at_ms(int ms) {
  VehicleTruth truth;
  truth.time = Time(std::chrono::milliseconds(ms));
  return truth;
}

ImuSensor::Params perfect() {
  ImuSensor::Params params = ImuSensor::mpu6000();
  params.gyroscope = {};
  params.accelerometer = {};
  return params;
}

TEST(ImuSensor, KeepsItsRateExactly) {
  const std::pair<ImuSensor::Params, int> sensors[] = {
      {ImuSensor::mpu6000(), 1000}, {ImuSensor::l3gd20h(), 200}, {ImuSensor::bno055(), 20}};
  for (const auto& [params, rate] : sensors) {
    ImuSensor imu(params, RandomStream(1, "imu"));
    int count = 0;
    Time last{};
    for (int ms = 1; ms <= 10000; ++ms) {
      const ImuReading* reading = imu.update(at_ms(ms));
      if (reading == nullptr) continue;
      ++count;
      EXPECT_EQ(reading->time - last, std::chrono::milliseconds(1000 / rate));
      last = reading->time;
    }
    EXPECT_EQ(count, 10 * rate);
  }
}

TEST(ImuSensor, WhiteNoiseHasTheDensityOfTheDataSheetAtAnyRate) {
  for (const double rate_hz : {1000.0, 100.0}) {
    ImuSensor::Params params = ImuSensor::mpu6000();
    params.rate_hz = rate_hz;
    params.gyroscope.bias_random_walk = params.accelerometer.bias_random_walk = 0.0;
    params.gyroscope.resolution = params.accelerometer.resolution = 0.0;
    ImuSensor imu(params, RandomStream(2, "imu0"));
    std::vector<double> gyro, accelerometer;
    const int step_ms = static_cast<int>(1000.0 / rate_hz);
    for (int i = 1; i <= 20000; ++i) {
      const ImuReading* reading = imu.update(at_ms(i * step_ms));
      ASSERT_NE(reading, nullptr);
      gyro.push_back(reading->sample.angular_velocity.y());
      accelerometer.push_back(reading->sample.specific_force.z());
    }
    // MPU-6000: 0.005 degrees/s/sqrt(Hz) and 400 micro-g/sqrt(Hz).
    EXPECT_NEAR(std::sqrt(test::variance(gyro) / rate_hz), 0.005 * M_PI / 180.0, 2e-6);
    EXPECT_NEAR(std::sqrt(test::variance(accelerometer) / rate_hz), 400e-6 * kGravity, 1e-4);
    EXPECT_NEAR(test::mean(accelerometer), kGravity, 4.0 * params.accelerometer.bias);
  }
}

TEST(ImuSensor, BiasesDifferByRunAndWalk) {
  ImuSensor::Params params = perfect();
  params.rate_hz = 100.0;
  params.gyroscope.bias = 0.01;
  params.gyroscope.bias_random_walk = 0.002;
  std::vector<double> first, change;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    ImuSensor imu(params, RandomStream(seed, "imu"));
    const double begin = imu.update(at_ms(10))->sample.angular_velocity.x();
    double end = begin;
    for (int ms = 20; ms <= 4010; ms += 10)
      end = imu.update(at_ms(ms))->sample.angular_velocity.x();
    first.push_back(begin);
    change.push_back(end - begin);
  }
  EXPECT_NEAR(std::sqrt(test::variance(first)), 0.01, 0.0015);
  EXPECT_NEAR(std::sqrt(test::variance(change)), 0.002 * std::sqrt(4.0), 0.0006);
}

TEST(ImuSensor, SaturatesAndQuantises) {
  ImuSensor::Params params = perfect();
  params.gyroscope.range = 2.0;
  params.accelerometer.resolution = 0.5;
  ImuSensor imu(params, RandomStream(1, "imu"));
  VehicleTruth truth = at_ms(1);
  truth.body.w_WB_B << 3.0, -50.0, 1.5;
  truth.specific_force << 0.2, 0.3, 9.8;
  const ImuSample sample = imu.update(truth)->sample;
  EXPECT_EQ(sample.angular_velocity, Vector3d(2.0, -2.0, 1.5));
  EXPECT_EQ(sample.specific_force, Vector3d(0.0, 0.5, 10.0));
}

TEST(ImuSensor, OffTheCentreItFeelsTheRotationInItsOwnAxes) {
  ImuSensor::Params params = perfect();
  params.mount.position << 0.1, 0.0, 0.0;
  params.mount.attitude = from_yaw(M_PI / 2.0);  // x of the sensor is y of the body
  ImuSensor imu(params, RandomStream(1, "imu"));
  VehicleTruth truth = at_ms(1);
  truth.specific_force.setZero();
  truth.body.w_WB_B << 0.0, 0.0, 5.0;
  truth.angular_acceleration << 0.0, 0.0, 20.0;
  const ImuSample sample = imu.update(truth)->sample;
  // Centripetal 2.5 m/s^2 along -x of the body, tangential 2 m/s^2 along +y.
  EXPECT_NEAR((sample.specific_force - Vector3d(2.0, 2.5, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(sample.angular_velocity.z(), 5.0, 1e-12);
}

}  // namespace
}  // namespace swiftlet
