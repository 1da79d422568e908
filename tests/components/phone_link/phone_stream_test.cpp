// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/phone_stream.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/components/phone_link/phones.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;
using testing::HasSubstr;
using Verdict = PhoneVerdict;

constexpr UdpEndpoint kPhone{0x7f000001, 40000};
constexpr UdpEndpoint kOther{0x7f000001, 40001};
constexpr Duration kPeriod = 33ms;

/// A vehicle that goes ahead at 1 m/s from (5, 6, 0.1), heading north, and its phone, whose frame
/// and clock are its own.
class PhoneStreamTest : public testing::Test {
 protected:
  PhoneStreamTest() {
    params_.frame.start_position = {5.0, 6.0, 0.1};
    params_.frame.start_yaw = 0.5 * M_PI;
    stream_ = PhoneStream(params_);
    pose_.session = 7;
  }
  Vector3d truth() const { return {5.0, 6.0 + to_seconds(now_ - begin_), 0.1}; }

  PhonePose measured() const {
    PhonePose pose = pose_;
    const double way = to_seconds(now_ - begin_);
    pose.time = now_.time_since_epoch() - 1000s + clock_;
    pose.position = offset_ + from_yaw(-1.0) * Vector3d(way, 0.0, 0.0);
    pose.attitude = from_yaw(-1.0);
    return pose;
  }
  PhoneStream::Received send(const PhonePose& pose, Duration delay = 2ms,
                             const UdpEndpoint& from = kPhone) {
    const DatagramBytes bytes = encode_binary(pose);
    return stream_.receive(bytes.data(), bytes.size(), from, now_ + delay);
  }
  PhoneStream::Received step(Duration delay = 2ms) {
    now_ += kPeriod;
    ++pose_.sequence;
    return send(measured(), delay);
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) ASSERT_EQ(step().verdict, Verdict::kAccepted);
  }

  PhoneStream::Params params_;
  PhoneStream stream_{params_};
  PhonePose pose_;
  const Time begin_{1'000'000s};
  Time now_ = begin_;
  Vector3d offset_{100.0, -50.0, 3.0};
  Duration clock_{0};
};

TEST_F(PhoneStreamTest, PosesAreThoseOfTheBodyInTheMapByOurClock) {
  const auto first = send(measured());
  ASSERT_EQ(first.verdict, Verdict::kAccepted);
  EXPECT_TRUE(first.new_phone);
  EXPECT_LT((first.pose.p_WB - truth()).norm(), 1e-9);
  for (int i = 0; i < 100; ++i) {
    const auto received = step();
    ASSERT_EQ(received.verdict, Verdict::kAccepted) << received.reason;
    EXPECT_FALSE(received.new_phone);
    EXPECT_EQ(received.reason, "");
    EXPECT_LT((received.pose.p_WB - truth()).norm(), 1e-6);
    EXPECT_NEAR(yaw_of(received.pose.q_WB), 0.5 * M_PI, 1e-9);
    EXPECT_NEAR(to_seconds(received.time - now_), 0.002, 1e-6) << "the delay is not known";
  }
  EXPECT_EQ(stream_.count(Verdict::kAccepted), 101U);
}

TEST_F(PhoneStreamTest, EachReasonIsCounted) {
  run(30);
  const PhonePose last = measured();

  DatagramBytes damaged = encode_binary(last);
  damaged[30] ^= 1;
  auto received = stream_.receive(damaged.data(), damaged.size(), kPhone, now_);
  EXPECT_EQ(received.verdict, Verdict::kCorrupt);
  EXPECT_THAT(received.reason, HasSubstr("checksum"));

  received = send(last, 2ms, kOther);
  EXPECT_EQ(received.verdict, Verdict::kForeign);
  EXPECT_THAT(received.reason, HasSubstr("the phone is 127.0.0.1:40000"));

  EXPECT_EQ(send(last).verdict, Verdict::kRepeated);

  now_ += kPeriod;
  pose_.sequence += 2;
  const PhonePose later = measured();
  EXPECT_EQ(send(later).verdict, Verdict::kAccepted);
  PhonePose earlier = later;
  --earlier.sequence;
  EXPECT_EQ(send(earlier).verdict, Verdict::kReordered);

  received = step(300ms);
  EXPECT_EQ(received.verdict, Verdict::kLate);
  EXPECT_THAT(received.reason, HasSubstr("0.29"));
  now_ += 300ms;

  ++pose_.sequence;
  PhonePose wild = measured();
  wild.position.x() += 30.0;
  received = send(wild);
  EXPECT_EQ(received.verdict, Verdict::kImplausible);

  EXPECT_EQ(step().verdict, Verdict::kAccepted);
  EXPECT_EQ(stream_.count(Verdict::kAccepted), 32U);
  for (const Verdict verdict : {Verdict::kCorrupt, Verdict::kForeign, Verdict::kRepeated,
                                Verdict::kReordered, Verdict::kLate, Verdict::kImplausible}) {
    EXPECT_EQ(stream_.count(verdict), 1U) << to_string(verdict);
  }
}

TEST_F(PhoneStreamTest, AJumpIsReportedAndFollowedWithoutAStep) {
  run(30);
  offset_ += Vector3d(0.0, 0.0, 2.0);
  for (int i = 1; i < params_.jump.confirmations; ++i) {
    EXPECT_EQ(step().verdict, Verdict::kImplausible);
  }
  auto received = step();
  ASSERT_EQ(received.verdict, Verdict::kAccepted);
  ASSERT_TRUE(received.jump);
  EXPECT_NEAR(received.jump->translation.z(), 2.0, 1e-6);
  Vector3d last = received.pose.p_WB;
  EXPECT_NEAR(last.z(), truth().z(), 0.02);
  for (int i = 0; i < 700; ++i) {
    received = step();
    ASSERT_EQ(received.verdict, Verdict::kAccepted);
    EXPECT_FALSE(received.jump);
    EXPECT_LE((received.pose.p_WB - last).norm(), 1.2 * to_seconds(kPeriod));
    last = received.pose.p_WB;
  }
  EXPECT_NEAR(last.z(), truth().z() + 2.0, 1e-6) << "where the phone says";
}

/// Its new frame has nothing to do with the old one, so there is nothing to follow.
TEST_F(PhoneStreamTest, APhoneThatIsStartedAgainGoesOnFromWhereTheVehicleWas) {
  run(30);
  const Vector3d before = stream_.jumps().last_output()->position;
  now_ += 3s;
  pose_.session = 8;
  pose_.sequence = 0;
  offset_ = {-7.0, 8.0, 9.0};
  clock_ = 500s;
  const auto received = send(measured(), 2ms, kOther);
  ASSERT_EQ(received.verdict, Verdict::kAccepted) << received.reason;
  EXPECT_TRUE(received.new_phone);
  EXPECT_FALSE(received.jump);
  EXPECT_LT((received.pose.p_WB - before).norm(), 1e-6);
  EXPECT_NEAR(yaw_of(received.pose.q_WB), 0.5 * M_PI, 1e-9);
  EXPECT_NEAR(to_seconds(received.time - now_), 0.002, 1e-6) << "its clock is new, too";
}

TEST_F(PhoneStreamTest, TheMeanOfTheFirstPosesFixesTheMap) {
  params_.start_poses = 100;
  stream_ = PhoneStream(params_);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto noisy = [&] {
    PhonePose pose = pose_;
    pose.sequence = ++pose_.sequence;
    pose.time = now_.time_since_epoch();
    pose.position = offset_;
    pose.attitude = from_yaw(0.27 * normal(random));
    return pose;
  };
  for (int i = 0; i < 100; ++i) {
    now_ += kPeriod;
    ASSERT_EQ(send(noisy()).verdict, Verdict::kAccepted);
  }
  now_ += kPeriod;
  PhonePose exact = noisy();
  exact.attitude.setIdentity();
  const auto received = send(exact);
  EXPECT_NEAR(yaw_of(received.pose.q_WB), 0.5 * M_PI, 0.11);  // 0.27 rad / sqrt(100), times 4
  EXPECT_LT((received.pose.p_WB - params_.frame.start_position).norm(), 1e-6);
}

TEST_F(PhoneStreamTest, AWildFirstPoseDoesNotFixTheMap) {
  PhonePose wild = measured();
  wild.position += Vector3d(20.0, 0.0, 0.0);
  send(wild);
  for (int i = 0; i < params_.jump.confirmations; ++i) step();
  const auto received = step();
  ASSERT_EQ(received.verdict, Verdict::kAccepted);
  // Anchored when the poses were believed: the vehicle stands, or moves little in that time.
  EXPECT_LT((received.pose.p_WB - params_.frame.start_position).norm(), 0.1);
  EXPECT_EQ(stream_.jumps().remaining().norm(), 0.0);
}

TEST_F(PhoneStreamTest, APhoneWhoseClockIsSetBackIsHeardAgain) {
  run(60);
  clock_ = -3600s;
  const auto received = step();
  EXPECT_EQ(received.verdict, Verdict::kAccepted) << received.reason;
  EXPECT_TRUE(received.clock_restarted);
  EXPECT_NEAR(to_seconds(received.time - now_), 0.002, 1e-3);
}

TEST_F(PhoneStreamTest, TheCovarianceIsThatOfTheDatagramOrTheParameters) {
  const auto without = send(measured());
  EXPECT_NEAR(without.pose.covariance(5, 5), 0.2727 * 0.2727, 1e-9);
  now_ += kPeriod;
  ++pose_.sequence;
  PhonePose pose = measured();
  Eigen::Matrix<double, 6, 1> diagonal;
  diagonal << 0.25, 1.0, 2.0, 0.5, 0.25, 0.125;
  pose.covariance = diagonal.asDiagonal();
  const auto with = send(pose);
  ASSERT_EQ(with.verdict, Verdict::kAccepted);
  // Turned from the phone's axes to those of the map.
  const Eigen::Matrix3d R = from_yaw(0.5 * M_PI + 1.0).toRotationMatrix();
  const Eigen::Matrix3d expected = R * diagonal.head<3>().asDiagonal() * R.transpose();
  EXPECT_LT((with.pose.covariance.topLeftCorner<3, 3>() - expected).norm(), 1e-6);
}

}  // namespace
}  // namespace swiftlet::test
