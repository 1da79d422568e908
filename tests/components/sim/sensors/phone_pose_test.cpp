// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/phone_pose.hpp"

#include "estimation/geometry/so3.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using std::chrono::milliseconds;

VehicleTruth at_ms(int ms) {
  VehicleTruth truth;
  truth.time = Time(milliseconds(ms));
  truth.body.p_WB << 1.0, 2.0, 1.2;
  truth.body.q_WB = exp_so3(Vector3d(0.1, -0.05, 0.8));
  return truth;
}

TEST(PhonePoseSensor, ErrorsAreThoseOfTable2) {
  // 100 flights of 100 s: drift has a time constant of 10 s, so that a flight has few
  // independent values of it.
  Vector3d square = Vector3d::Zero();
  double psi_square = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    PhonePoseSensor phone({}, RandomStream(seed, "phone"));
    for (int ms = 1; ms <= 100000; ++ms) {
      const VehicleTruth truth = at_ms(ms);
      const PhonePoseReading* pose = phone.update(truth);
      if (pose == nullptr) continue;
      ++count;
      square += (pose->position - truth.body.p_WB).cwiseAbs2();
      const Eigen::Matrix3d R = (truth.body.q_WB.conjugate() * pose->attitude).matrix();
      const double psi = 0.5 * (3.0 - R.trace());
      psi_square += psi * psi;
      ASSERT_NEAR(pose->attitude.norm(), 1.0, 1e-12);
    }
  }
  EXPECT_EQ(count, 300000);
  const Vector3d rmse = (square / count).cwiseSqrt();
  EXPECT_NEAR(rmse.x(), 0.0165, 0.05 * 0.0165);
  EXPECT_NEAR(rmse.y(), 0.0320, 0.05 * 0.0320);
  EXPECT_NEAR(rmse.z(), 0.0274, 0.05 * 0.0274);
  EXPECT_NEAR(std::sqrt(psi_square / count), 0.0627, 0.001);
}

TEST(PhonePoseSensor, HalfOfTheVarianceIsDriftWithItsTimeConstant) {
  std::vector<double> products(21, 0.0);  // over lags of 1 s
  constexpr int kFlights = 300;
  for (std::uint64_t seed = 0; seed < kFlights; ++seed) {
    PhonePoseSensor phone({}, RandomStream(seed, "phone"));
    std::vector<double> error;
    for (int ms = 1; ms <= 40000; ++ms) {
      const VehicleTruth truth = at_ms(ms);
      const PhonePoseReading* pose = phone.update(truth);
      if (pose != nullptr) error.push_back(pose->position.y() - truth.body.p_WB.y());
    }
    for (std::size_t lag = 0; lag < products.size(); ++lag) {
      for (std::size_t i = 0; i < 600; ++i) {
        products[lag] += error[i] * error[i + 30 * lag] / (600.0 * kFlights);
      }
    }
  }
  const double variance = 0.0320 * 0.0320;
  EXPECT_NEAR(products[0] / variance, 1.0, 0.1);
  // White noise is gone after one sample; the drift decays.
  EXPECT_NEAR(products[1] / variance, 0.5 * std::exp(-0.1), 0.08);
  EXPECT_NEAR(products[10] / products[1], std::exp(-0.9), 0.12);
}

TEST(PhonePoseSensor, YawCarriesTheAttitudeError) {
  PhonePoseSensor phone({}, RandomStream(3, "phone"));
  std::vector<double> tilt, yaw;
  for (int ms = 1; ms <= 200000; ++ms) {
    const VehicleTruth truth = at_ms(ms);
    const PhonePoseReading* pose = phone.update(truth);
    if (pose == nullptr) continue;
    const Vector3d n = log_so3(pose->attitude * truth.body.q_WB.conjugate());
    tilt.push_back(n.x());
    yaw.push_back(n.z());
  }
  EXPECT_NEAR(std::sqrt(test::variance(tilt)), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(test::variance(yaw)), 0.2727, 0.01);
  EXPECT_NEAR(test::autocorrelation(yaw, 1), 0.0, 0.05);
}

TEST(PhonePoseSensor, PosesArriveLateWithTheTimeAtWhichTheyWereTaken) {
  PhonePoseSensor::Params params;
  params.latency_ms = 70.0;  // more than two periods: several are on the way
  PhonePoseSensor late(params, RandomStream(4, "phone"));
  PhonePoseSensor prompt({}, RandomStream(4, "phone"));
  std::vector<PhonePoseReading> expected;
  int arrived = 0;
  for (int ms = 1; ms <= 2000; ++ms) {
    if (const auto* pose = prompt.update(at_ms(ms))) expected.push_back(*pose);
    const PhonePoseReading* pose = late.update(at_ms(ms));
    if (pose == nullptr) continue;
    EXPECT_EQ(pose->time + milliseconds(70), Time(milliseconds(ms)));
    EXPECT_EQ(pose->time, expected.at(arrived).time);
    EXPECT_EQ(pose->position, expected.at(arrived).position);
    ++arrived;
  }
  EXPECT_EQ(expected.size(), 60U);
  EXPECT_EQ(arrived, 57);
}

TEST(PhonePoseSensor, DropsAsOftenAsAsked) {
  PhonePoseSensor::Params params;
  params.drop_probability = 0.25;
  PhonePoseSensor phone(params, RandomStream(5, "phone"));
  int count = 0;
  for (int ms = 1; ms <= 200000; ++ms) count += phone.update(at_ms(ms)) != nullptr;
  EXPECT_NEAR(count / 6000.0, 0.75, 0.025);
}

}  // namespace
}  // namespace swiftlet
