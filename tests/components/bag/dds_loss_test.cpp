// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the middleware says of samples that did not arrive, and what the ledger makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/bag/loss_ledger.hpp"
#include "components/bag/recorder.hpp"
#include "components/bag/recording.hpp"
#include "tests/components/bag/scripted_traffic.hpp"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

Cdr numbered(std::uint8_t number) {
  return {0, 1, 0, 0, number};
}

class DdsLoss : public testing::Test {
 protected:
  std::shared_ptr<Participant> participant() {
    ParticipantOptions options;
    options.domain = lease_.domain();
    options.isolated = true;
    return std::make_shared<Participant>(options);
  }
  test::DomainLease lease_;
};

/// Samples that a slow reader's history has no room for.
TEST_F(DdsLoss, OverwrittenSamplesAreGapsInTheNumbersOfTheirWriter) {
  for (QosProfile qos : {qos::sensor, qos::state}) {
    const auto process = participant();
    qos.depth = 4;
    const EndpointSpec spec{"rt/scan", kScanType, qos, "test", nullptr};
    const auto reader = process->make_reader(spec, [] {});
    const auto writer = process->make_writer(spec);
    SequenceWatch watch;
    std::uint64_t missing = 0, taken = 0;
    std::uint8_t last = 0;
    for (std::uint8_t number = 1; number <= 100; ++number) {
      writer->write(numbered(number));
      if (number % 10 != 1) continue;  // after one, then after ten each
      Cdr cdr;
      SampleOrigin origin;
      while (reader->take(cdr, &origin)) {
        ++taken;
        EXPECT_EQ(origin.sequence, cdr[4]) << "a writer counts from 1 on";
        EXPECT_GT(origin.written, Time(1'000'000'000s)) << "time of day";
        missing += watch.missing_before(origin.writer, origin.sequence);
        last = cdr[4];
      }
    }
    EXPECT_EQ(last, 91);
    EXPECT_EQ(taken, 1U + 9U * 4U);
    EXPECT_EQ(missing, 91U - taken) << qos.name;
    // Why the ledger does not rest on the status of DDS: Fast DDS 2.9 counts in it what was lost
    // on the way, and not what a full history of the reader lost.
    EXPECT_EQ(reader->lost(), 0U) << qos.name;
  }
}

TEST_F(DdsLoss, NothingIsMissingForOneThatComesLate) {
  for (const QosProfile& qos : {qos::sensor, qos::state, qos::map}) {
    const auto process = participant();
    const EndpointSpec spec{"rt/scan", kScanType, qos, "test", nullptr};
    const auto writer = process->make_writer(spec);
    for (std::uint8_t number = 1; number <= 50; ++number) writer->write(numbered(number));
    const auto reader = process->make_reader(spec, [] {});
    for (std::uint8_t number = 51; number <= 60; ++number) writer->write(numbered(number));
    SequenceWatch watch;
    Cdr cdr;
    SampleOrigin origin;
    while (reader->take(cdr, &origin)) {
      EXPECT_EQ(watch.missing_before(origin.writer, origin.sequence), 0U) << qos.name;
    }
  }
}

/// Publishes a burst of large samples as fast as it can, some small ones among them, and ends the
/// run as soon as the recorder has met or missed each of them.
struct Burst : Component {
  static constexpr std::size_t kLarge = 300, kSmallPerLarge = 3;
  explicit Burst(const ComponentContext& context) : Component(context) {
    QosProfile large = qos::event;
    large.depth = 1000;
    image_ = advertise_raw("rt/image", "test::msg::dds_::Blob_", large);
    imu_ = advertise_raw("rt/imu0", kImuType, large);
    every(10ms, [this](Time) { spoken_ ? wait() : speak(); });
  }
  void wait() {
    const Recorder::Progress progress = recorder->progress();
    if (progress.messages + progress.lost_by_dds >= kLarge * (1 + kSmallPerLarge)) stop(0);
  }
  void speak() {
    if (image_->matched_readers() == 0 || imu_->matched_readers() == 0) return;
    spoken_ = true;
    std::mt19937 random(1);
    Cdr cdr = random_cdr(random, 1);
    cdr.resize(1'000'000);
    for (auto& byte : cdr) byte = static_cast<std::uint8_t>(random());
    cdr[0] = cdr[2] = cdr[3] = 0;
    cdr[1] = 1;
    const Cdr small(100, 1);
    for (std::size_t i = 0; i < kLarge; ++i) {
      image_->write(cdr);
      for (std::size_t j = 0; j < kSmallPerLarge; ++j) imu_->write(small);
    }
    call_at(now() + 30s, [this](Time) { stop(0); });  // what is missing then shows in the counts
  }
  const Recorder* recorder = nullptr;
  bool spoken_ = false;
  std::shared_ptr<Writer> image_, imu_;
};

TEST_F(DdsLoss, WhatIsNotInTheFileIsInItsLedger) {
  const TemporaryFolder folder;
  HostOptions options;
  options.participant.domain = lease_.domain();
  options.participant.isolated = true;
  Host host(options);
  auto& burst = host.emplace<Burst>("burst");
  RecorderParams params;
  params.file = folder / "f.mcap";
  params.max_memory = 4'000'000;
  auto& recorder = host.emplace<Recorder>("recorder", params);
  burst.recorder = &recorder;
  ASSERT_EQ(host.run(), 0);
  ASSERT_TRUE(recorder.close().ok());
  const auto reader = mcap::Reader::open(params.file);
  const auto ledger = losses_of(*reader);
  ASSERT_TRUE(ledger);
  EXPECT_EQ(*ledger, recorder.losses());
  std::map<std::string, std::uint64_t> recorded;
  for (const Sample& sample : mcap::read_samples(*reader)) ++recorded[sample.topic];
  EXPECT_LT(recorded["image"], Burst::kLarge) << "the burst must not fit, or nothing is tested";
  EXPECT_GT(ledger->at("image").by_recorder, 0U);
  EXPECT_EQ(recorded["image"] + ledger->at("image").total(), Burst::kLarge);
  const auto imu = ledger->find("imu0");
  EXPECT_EQ(imu == ledger->end() ? 0U : imu->second.by_recorder, 0U)
      << "what is small still has room";
}

}  // namespace
}  // namespace swiftlet
