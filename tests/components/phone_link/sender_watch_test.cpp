// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/sender_watch.hpp"

#include <gtest/gtest.h>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using Verdict = SenderWatch::Verdict;

constexpr UdpEndpoint kPhone{0x0a000002, 40000};
constexpr UdpEndpoint kSameHost{0x0a000002, 40001};
constexpr UdpEndpoint kOtherHost{0x0a000003, 40000};

class SenderWatchTest : public testing::Test {
 protected:
  Verdict judge(const UdpEndpoint& sender, std::uint32_t session, std::uint32_t sequence) {
    return watch_.judge(sender, session, sequence, now_);
  }

  SenderWatch::Params params_;
  SenderWatch watch_{params_};
  Time now_{100s};
};

TEST_F(SenderWatchTest, TheFirstSenderIsThePhoneAndOthersAreForeign) {
  EXPECT_EQ(judge(kPhone, 7, 0), Verdict::kNewPhone);
  EXPECT_EQ(judge(kPhone, 7, 1), Verdict::kNew);
  EXPECT_EQ(judge(kSameHost, 8, 2), Verdict::kForeign);
  EXPECT_EQ(judge(kSameHost, 7, 2), Verdict::kForeign);
  EXPECT_EQ(judge(kOtherHost, 7, 2), Verdict::kForeign);
  EXPECT_EQ(judge(kPhone, 8, 2), Verdict::kForeign) << "another session";
  EXPECT_EQ(judge(kPhone, 7, 2), Verdict::kNew);
  EXPECT_EQ(*watch_.phone(), kPhone);
}

TEST_F(SenderWatchTest, AfterASilenceItsHostMayBeginAnew) {
  judge(kPhone, 7, 100);
  now_ += 1900ms;
  EXPECT_EQ(judge(kSameHost, 8, 0), Verdict::kForeign);
  now_ += 200ms;
  EXPECT_EQ(judge(kOtherHost, 8, 0), Verdict::kForeign);
  EXPECT_EQ(judge(kSameHost, 8, 0), Verdict::kNewPhone);
  EXPECT_EQ(judge(kSameHost, 8, 1), Verdict::kNew);
  EXPECT_EQ(judge(kPhone, 7, 101), Verdict::kForeign);
}

TEST_F(SenderWatchTest, ForeignDatagramsDoNotKeepAPhoneAlive) {
  judge(kPhone, 7, 100);
  for (int i = 0; i < 25; ++i) {
    now_ += 100ms;
    judge(kOtherHost, 9, 0);
    judge(kPhone, 7, 100);
  }
  EXPECT_EQ(judge(kSameHost, 8, 0), Verdict::kNewPhone);
}

TEST_F(SenderWatchTest, AnotherHostTakesOverOnlyWhereThatIsAskedFor) {
  params_.any_sender = true;
  watch_ = SenderWatch(params_);
  judge(kPhone, 7, 100);
  EXPECT_EQ(judge(kOtherHost, 8, 0), Verdict::kForeign) << "while the phone is heard";
  now_ += 3s;
  EXPECT_EQ(judge(kOtherHost, 8, 0), Verdict::kNewPhone);
}

TEST_F(SenderWatchTest, OnlyTheNamedHostCounts) {
  params_.only_from = kOtherHost.address;
  params_.any_sender = true;
  watch_ = SenderWatch(params_);
  EXPECT_EQ(judge(kPhone, 7, 0), Verdict::kForeign);
  EXPECT_FALSE(watch_.phone());
  EXPECT_EQ(judge(kOtherHost, 7, 0), Verdict::kNewPhone);
}

TEST_F(SenderWatchTest, EachNumberCountsOnceAndInOrder) {
  judge(kPhone, 7, 10);
  EXPECT_EQ(judge(kPhone, 7, 10), Verdict::kRepeated);
  EXPECT_EQ(judge(kPhone, 7, 13), Verdict::kNew);
  EXPECT_EQ(judge(kPhone, 7, 12), Verdict::kReordered);
  EXPECT_EQ(judge(kPhone, 7, 12), Verdict::kRepeated);
  EXPECT_EQ(judge(kPhone, 7, 10), Verdict::kRepeated);
  EXPECT_EQ(judge(kPhone, 7, 500), Verdict::kNew);
  EXPECT_EQ(judge(kPhone, 7, 13), Verdict::kReordered) << "too long ago to say";
}

TEST_F(SenderWatchTest, NumbersWrapAround) {
  judge(kPhone, 7, 0xfffffffe);
  EXPECT_EQ(judge(kPhone, 7, 0xffffffff), Verdict::kNew);
  EXPECT_EQ(judge(kPhone, 7, 0), Verdict::kNew);
  EXPECT_EQ(judge(kPhone, 7, 1), Verdict::kNew);
  EXPECT_EQ(judge(kPhone, 7, 0xffffffff), Verdict::kRepeated);
}

/// A datagram that the network kept for long is no phone that comes back.
TEST_F(SenderWatchTest, AStrayDatagramAfterASilenceIsStillOld) {
  judge(kPhone, 7, 10);
  judge(kPhone, 7, 11);
  now_ += 60s;
  EXPECT_EQ(judge(kPhone, 7, 11), Verdict::kRepeated);
  EXPECT_EQ(judge(kSameHost, 7, 9), Verdict::kReordered);
  EXPECT_EQ(judge(kSameHost, 7, 12), Verdict::kNew) << "the same run of the phone, another port";
  EXPECT_EQ(judge(kPhone, 7, 13), Verdict::kForeign);
}

}  // namespace
}  // namespace swiftlet
