// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Between the datagrams of a phone, others that are mutations of them: nothing crashes, and no pose
// is accepted that was not sent.
//
// A damaged datagram passes a CRC-32 by chance once in 2^32. Of the ten million of the long form
// one in 400 runs would have one; the seed is fixed, so either all runs do or none does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "components/phone_link/phone_stream.hpp"
#include "tests/components/phone_link/phones.hpp"
#include "tests/fuzz/mutation.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;

constexpr UdpEndpoint kPhone{0x7f000001, 40000};
constexpr int kShortForm = 100'000;
constexpr int kLongForm = 10'000'000;

int mutations() {
  const char* full = std::getenv("SWIFTLET_FULL_TESTS");
  return full != nullptr && std::string(full) == "1" ? kLongForm : kShortForm;
}

class DamagedDatagrams : public testing::Test {
 protected:
  PhonePose next_pose() {
    PhonePose pose = random_pose(random_);
    pose.session = 7;
    pose.sequence = ++sequence_;
    now_ += 33ms;
    pose.time = now_.time_since_epoch();
    pose.position *= 0.001;  // so that all are plausible
    pose.attitude.setIdentity();
    return pose;
  }

  /// Each of the phone's datagrams arrives, after mutations of it and of the ones before it.
  template <class Encode>
  void run(PhoneStream::Params params, Encode encode, int count) {
    PhoneStream stream(params);
    DatagramBytes before = encode(next_pose());
    int accepted_mutants = 0;
    constexpr int kMutantsOfEach = 20;
    for (int done = 0; done < count; done += kMutantsOfEach) {
      const PhonePose pose = next_pose();
      const DatagramBytes sound = encode(pose);
      // Of the same numbers in the same places: what is in the sound datagram and nothing else.
      const DatagramBytes sent = encode_binary(pose);
      const DatagramBytes sent_before = encode_binary(decode(before).value());
      for (int i = 0; i < kMutantsOfEach; ++i) {
        const fuzz::Bytes mutant = fuzz::mutated(sound, before, 2 * kLongestDatagram, random_);
        const auto received = stream.receive(mutant.data(), mutant.size(), kPhone, now_ + 2ms);
        if (received.verdict != PhoneVerdict::kAccepted) continue;
        ++accepted_mutants;
        const DatagramBytes taken = encode_binary(received.datagram);
        ASSERT_TRUE(taken == sent || taken == sent_before)
            << "not sent: " << testing::PrintToString(mutant);
      }
      const auto received = stream.receive(sound.data(), sound.size(), kPhone, now_ + 2ms);
      // Unless a mutant was the same again, or said the same.
      ASSERT_TRUE(received.verdict == PhoneVerdict::kAccepted ||
                  received.verdict == PhoneVerdict::kRepeated)
          << received.reason;
      before = sound;
    }
    EXPECT_GT(stream.count(PhoneVerdict::kCorrupt), static_cast<std::uint64_t>(count) / 2);
    RecordProperty("accepted_mutants", accepted_mutants);
  }

  std::mt19937 random_{1};
  std::uint32_t sequence_ = 0;
  Time now_{1000s};
};

TEST_F(DamagedDatagrams, InBinaryNoneIsFlown) {
  run({}, encode_binary, mutations());
}

TEST_F(DamagedDatagrams, InCheckedJsonNoneIsFlown) {
  PhoneStream::Params params;
  params.json = JsonPolicy::kChecked;
  run(params, encode_json, mutations() / 5);  // which takes ten times as long
}

}  // namespace
}  // namespace swiftlet::test
