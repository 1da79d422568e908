// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The simulated phone and the link's own end, without a network between: what goes in is the
// motion, what comes out is the motion with the phone's errors.
#include "components/phone_sim/phone_simulator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "components/phone_link/phone_stream.hpp"
#include "components/phone_sim/made_up_motion.hpp"
#include "estimation/geometry/so3.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

constexpr UdpEndpoint kPhone{0x7f000001, 40000};
constexpr Time kBegin{1'700'000'000s};

PhoneSimulator::Params perfect() {
  PhoneSimulator::Params params;
  params.sensor.position_rmse.setZero();
  params.sensor.tilt_stddev = 0.0;
  params.sensor.yaw_stddev = 0.0;
  params.session = 7;
  return params;
}

/// Moves for `seconds`; calls `each(received, truth)` for every datagram.
template <class Each>
void fly(const PhoneSimulator::Params& phone, PhoneStream& stream, double seconds,
         MadeUpMotion motion, Each each) {
  PhoneSimulator simulator(phone, 3);
  for (Time time{}; to_seconds(time) < seconds; time += 2ms) {
    const VehicleTruth truth = made_up_truth(motion, time);
    const auto bytes = simulator.update(truth);
    if (!bytes) continue;
    each(stream.receive(bytes->data(), bytes->size(), kPhone, kBegin + time.time_since_epoch()),
         truth);
  }
}

PhoneStream::Params link() {
  PhoneStream::Params params;
  const VehicleTruth first = made_up_truth(MadeUpMotion::kCircle, Time(34ms));
  params.frame.start_position = first.body.p_WB;
  params.frame.start_yaw = yaw_of(first.body.q_WB);
  return params;
}

TEST(PhoneSimulator, APerfectPhoneGivesTheMotionBack) {
  PhoneSimulator::Params phone = perfect();
  phone.clock_offset = 12345.0;
  phone.clock_drift = 80e-6;
  phone.sensor.mount = {{0.12, 0.0, -0.03}, exp_so3({0.1, -0.2, 1.5})};
  for (const bool json : {false, true}) {
    phone.json = json;
    PhoneStream::Params params = link();
    params.json = JsonPolicy::kChecked;
    params.frame.camera = {phone.sensor.mount.position, phone.sensor.mount.attitude};
    PhoneStream stream(params);
    int accepted = 0;
    fly(phone, stream, 60.0, MadeUpMotion::kCircle,
        [&](const PhoneStream::Received& received, const VehicleTruth& truth) {
          ASSERT_EQ(received.verdict, PhoneVerdict::kAccepted) << received.reason;
          ++accepted;
          EXPECT_LT((received.pose.p_WB - truth.body.p_WB).norm(), 1e-5);
          EXPECT_LT(received.pose.q_WB.angularDistance(truth.body.q_WB), 1e-5);
          EXPECT_NEAR(to_seconds(received.time - kBegin) - to_seconds(truth.time), 0.0, 1e-3);
        });
    EXPECT_NEAR(accepted, 60 * 30, 2);
    EXPECT_NEAR(stream.clock().skew(), -80e-6, 5e-6);
  }
}

TEST(PhoneSimulator, ThePhoneOfThePaperHasItsErrorsAndNoJumps) {
  PhoneStream::Params params = link();
  params.start_poses = 100;
  PhoneStream stream(params);
  Vector3d sum = Vector3d::Zero();
  Vector3d sum_of_squares = Vector3d::Zero();
  int count = 0;
  fly({}, stream, 600.0, MadeUpMotion::kHover,
      [&](const PhoneStream::Received& received, const VehicleTruth& truth) {
        ASSERT_EQ(received.verdict, PhoneVerdict::kAccepted) << received.reason;
        EXPECT_FALSE(received.jump);
        if (truth.time < Time(10s)) return;
        const Vector3d error = received.pose.p_WB - truth.body.p_WB;
        sum += error;
        sum_of_squares += error.cwiseAbs2();
        ++count;
      });
  ASSERT_GT(count, 17'000);
  const Vector3d mean = sum / count;
  const Vector3d stddev = (sum_of_squares / count - mean.cwiseAbs2()).cwiseSqrt();
  EXPECT_LT(mean.norm(), 0.08) << "what the drift was at the start, and its own mean";
  // Table 2 of seed 000.
  EXPECT_NEAR(stddev.x(), 0.0165, 0.0035);
  EXPECT_NEAR(stddev.y(), 0.0320, 0.0065);
  EXPECT_NEAR(stddev.z(), 0.0274, 0.0055);
}

TEST(PhoneSimulator, AJumpIsOneJump) {
  PhoneSimulator::Params phone = perfect();
  phone.jump = PhoneSimulator::Jump{10.0, {0.5, -0.5, 0.1}, 0.3};
  PhoneStream stream(link());
  int jumps = 0;
  std::optional<Vector3d> last;
  Time last_time{};
  fly(phone, stream, 60.0, MadeUpMotion::kCircle,
      [&](const PhoneStream::Received& received, const VehicleTruth&) {
        if (received.verdict != PhoneVerdict::kAccepted) return;
        jumps += received.jump.has_value();
        if (last) {
          // The vehicle's 0.5 m/s, what is followed, and what a period of it is off by.
          EXPECT_LE((received.pose.p_WB - *last).norm(),
                    0.65 * to_seconds(received.time - last_time) + 1e-3);
        }
        last = received.pose.p_WB;
        last_time = received.time;
      });
  EXPECT_EQ(jumps, 1);
  EXPECT_EQ(stream.jumps().remaining().norm(), 0.0) << "followed to the end";
  EXPECT_EQ(stream.count(PhoneVerdict::kImplausible), 4U);
}

}  // namespace
}  // namespace swiftlet
