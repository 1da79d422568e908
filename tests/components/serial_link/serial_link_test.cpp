// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Both ends of a serial link in real time, each in a domain of its own, over pseudo-terminals with
// a line between them that is as slow and as bad as a radio.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <set>

#include "tests/components/component_bench.hpp"
#include "tests/components/serial_link/lossy_line.hpp"
#include "tests/slowdown.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using swiftlet_msgs::msg::CommandAck;
using swiftlet_msgs::msg::ModeCommand;
using swiftlet_msgs::msg::Telemetry;
using testing::HasSubstr;

constexpr const char* kSilence = "nothing is heard from the other end";

/// Waits until `condition` holds, for `limit` at most.
template <class Condition>
bool eventually(Condition condition, std::chrono::seconds limit = 10s) {
  const auto deadline = std::chrono::steady_clock::now() + limit * static_cast<int>(kSlowdown);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

/// A host with one end of the link, and a probe beside it, that runs in a thread of its own.
class End {
 public:
  End(int domain, const std::string& yaml) : host_(options(domain)) {
    host_.add("serial_link", Config::parse(yaml, "link.yaml"));
    probe_ = &host_.emplace<Probe>("probe");
    probe_->every(10ms, [this](Time) { pauses.tick(); });
    probe_->subscribe(topic::diagnostics, [this](const diagnostic_msgs::msg::DiagnosticArray& m) {
      const std::lock_guard<std::mutex> lock(mutex_);
      report_ = m.status().front();
    });
  }
  ~End() {
    if (!thread_.joinable()) return;
    host_.executor().stop(0);
    thread_.join();
  }
  void start() {
    thread_ = std::thread([this] { host_.run(); });
  }
  Probe& probe() { return *probe_; }
  Pauses pauses;
  diagnostic_msgs::msg::DiagnosticStatus report() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return report_;
  }
  /// Of the last report; -1 where it is not there.
  double value(const std::string& key) {
    const auto last = report();
    for (const auto& entry : last.values()) {
      if (entry.key() == key) return std::stod(entry.value());
    }
    return -1.0;
  }

 private:
  static HostOptions options(int domain) {
    HostOptions options;
    options.participant.name = "test";
    options.participant.domain = domain;
    return options;
  }

  Host host_;
  Probe* probe_ = nullptr;
  std::mutex mutex_;
  diagnostic_msgs::msg::DiagnosticStatus report_;
  std::thread thread_;
};

/// A vehicle that says how it is five times a second in 200 bytes, and answers commands once each;
/// a ground station that listens.
class SerialLink : public testing::Test {
 protected:
  void start(const std::string& vehicle_device, const std::string& ground_device) {
    vehicle_.emplace(77, "role: vehicle\ndevice: " + vehicle_device + "\n");
    ground_.emplace(78, "role: ground\ndevice: " + ground_device + "\n");
    Probe& vehicle = vehicle_->probe();
    auto telemetry = vehicle.advertise(topic::telemetry);
    vehicle.every(200ms, [this, telemetry](Time now) mutable {
      if (telemetry.matched_readers() == 0) return;
      telemetry.publish(message(++sent_, now));
    });
    auto ack = vehicle.advertise(topic::mode_ack);
    vehicle.subscribe(topic::mode, [this, ack](const ModeCommand& command) mutable {
      const std::lock_guard<std::mutex> lock(mutex_);
      // As the commander does: a command that was asked for again just before its answer came may
      // arrive after the next one.
      const auto& known = carried_out_;
      if (std::find(known.begin(), known.end(), command.id()) == known.end()) {
        carried_out_.push_back(command.id());
      }
      CommandAck answer;
      answer.id(command.id());
      answer.accepted(false);
      answer.reason(std::string(500, 'r'));
      ack.publish(answer);
    });
    Probe& ground = ground_->probe();
    ground.subscribe(topic::telemetry, [this](const Telemetry& heard) {
      const std::lock_guard<std::mutex> lock(mutex_);
      const Time stamp = from_msg(heard.stamp());
      if (!(heard == message(heard.item(), stamp))) ++wrong_;
      ages_.push_back(to_seconds(ground_->probe().now() - stamp));
      newest_ = heard.item();
    });
    ground.subscribe(topic::mode_ack, [this](const CommandAck& heard) {
      const std::lock_guard<std::mutex> lock(mutex_);
      acks_.push_back(heard);
    });
  }
  void run() {
    vehicle_->start();
    ground_->start();
  }
  static Telemetry message(std::uint32_t number, Time now) {
    Telemetry telemetry;
    telemetry.stamp(to_msg(now));
    telemetry.item(static_cast<std::uint16_t>(number));
    telemetry.reason(std::string(99, 'x'));
    return telemetry;
  }
  std::size_t heard() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ages_.size();
  }
  /// Seconds that the machine had no time for one of the three [s].
  double paused(const LossyLine& line) {
    return line.pauses.total_s() + vehicle_->pauses.total_s() + ground_->pauses.total_s();
  }
  /// Ends both, so that what they noted can be looked at.
  void end() {
    vehicle_.reset();
    ground_.reset();
  }

  std::mutex mutex_;
  std::atomic<std::uint32_t> sent_{0};
  std::vector<double> ages_;
  int wrong_ = 0;
  std::uint16_t newest_ = 0;
  std::vector<std::string> carried_out_;
  std::vector<CommandAck> acks_;
  std::optional<End> vehicle_;
  std::optional<End> ground_;
};

TEST_F(SerialLink, CarriesTelemetryAtFiveHertzOver19200Baud) {
  ASSERT_EQ(to_cdr(message(1, Time(1s))).size(), 200u);
  LossyLine line;
  start(line.vehicle(), line.ground());
  run();
  ASSERT_TRUE(eventually([&] { return heard() >= 5; }));
  const std::size_t before = heard();
  const std::uint32_t sent_before = sent_;
  const std::uint64_t carried_before = line.carried;
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(eventually([&] { return sent_ >= sent_before + 50; }, 30s));
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double share = static_cast<double>(line.carried - carried_before) / seconds / 1920.0;
  const std::size_t received = heard() - before;
  EXPECT_TRUE(eventually([&] { return vehicle_->value("bytes_sent_per_s") > 900.0; }));
  const double paused_s = paused(line);
  EXPECT_LT(ground_->value("link_age_s"), 1.0 * kSlowdown + paused_s);
  end();
  std::sort(ages_.begin(), ages_.end());
  std::printf(
      "%zu of 50 in %.1f s, %.0f %% of the line; age %.3f s (median), %.3f s (worst); "
      "machine busy for %.3f s\n",
      received, seconds, 100.0 * share, ages_[ages_.size() / 2], ages_.back(), paused_s);
  EXPECT_EQ(wrong_, 0);
  EXPECT_GE(static_cast<double>(received), 45.0 - 5.0 * paused_s);
  EXPECT_LT(share, 0.6);
  EXPECT_LT(ages_[ages_.size() / 2], 0.2 * kSlowdown);
  EXPECT_LT(ages_.back(), 0.5 * kSlowdown + paused_s);
}

TEST_F(SerialLink, NoCommandIsLostAndNothingDamagedIsBelievedOnABadLine) {
  LossyLine line;
  line.lost = 0.001;
  line.damaged = 0.001;
  start(line.vehicle(), line.ground());
  auto mode = ground_->probe().advertise(topic::mode);
  std::atomic<std::size_t> answered{0};
  ground_->probe().every(200ms, [&](Time now) {
    if (mode.matched_readers() == 0) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    std::set<std::string> ids;
    for (const CommandAck& ack : acks_) ids.insert(ack.id());
    answered = ids.size();
    ModeCommand command;
    command.header(make_header(now, frame::kMap));
    command.id("gcs-1234-" + std::to_string(answered));
    if (answered < 20) mode.publish(command);
  });
  run();
  ASSERT_TRUE(eventually([&] { return answered >= 20; }, 60s)) << answered;
  EXPECT_TRUE(eventually([&] { return ground_->value("frames_damaged") > 0.0; }));
  EXPECT_TRUE(eventually([&] { return ground_->value("frames_lost") > 0.0; }));
  std::printf("ground: %.0f frames, %.0f damaged, %.0f lost; vehicle: %.0f, %.0f, %.0f\n",
              ground_->value("frames_received"), ground_->value("frames_damaged"),
              ground_->value("frames_lost"), vehicle_->value("frames_received"),
              vehicle_->value("frames_damaged"), vehicle_->value("frames_lost"));
  end();
  ASSERT_EQ(carried_out_.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(carried_out_[i], "gcs-1234-" + std::to_string(i)) << "in their order, once each";
  }
  for (const CommandAck& ack : acks_) {
    EXPECT_FALSE(ack.accepted());
    EXPECT_THAT(ack.reason(), testing::MatchesRegex("r+")) << "its beginning";
    EXPECT_GT(ack.reason().size(), 150u);
  }
  EXPECT_EQ(wrong_, 0);
  EXPECT_GT(ages_.size(), 10u);
}

TEST_F(SerialLink, AfterACutTheNewestTelemetryComesAndNothingOld) {
  LossyLine line;
  start(line.vehicle(), line.ground());
  run();
  ASSERT_TRUE(eventually([&] { return heard() >= 5; }));
  line.cut = true;
  ASSERT_TRUE(eventually([&] { return ground_->report().message() == kSilence; }, 20s));
  EXPECT_GT(ground_->value("link_age_s"), 3.0);
  std::uint16_t newest_before = 0;
  std::size_t count_before = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_before = newest_;
    count_before = ages_.size();
  }
  line.cut = false;
  ASSERT_TRUE(eventually([&] { return heard() >= count_before + 10; }));
  const std::uint32_t now_sent = sent_;
  const double paused_s = paused(line);
  end();
  EXPECT_GT(now_sent - newest_before, 20u) << "of the cut itself, nothing came";
  EXPECT_LT(ages_.size(), now_sent - 10u);
  for (std::size_t i = count_before; i < ages_.size(); ++i)
    EXPECT_LT(ages_[i], 0.5 * kSlowdown + paused_s);
  EXPECT_EQ(wrong_, 0);
}

TEST_F(SerialLink, ADeviceThatVanishesIsOpenedAgainWhenItIsBack) {
  auto line = std::make_unique<LossyLine>();
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("serial-link-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path device = folder / "ttyUSB0";
  std::filesystem::create_symlink(line->vehicle(), device);
  std::filesystem::create_symlink(line->ground(), folder / "ground");
  start(device.string(), (folder / "ground").string());
  run();
  ASSERT_TRUE(eventually([&] { return heard() >= 3; }));
  line.reset();
  ASSERT_TRUE(eventually([&] { return vehicle_->report().level() == 2; }));
  EXPECT_THAT(vehicle_->report().message(), HasSubstr(device.string()));
  std::filesystem::remove(device);
  std::filesystem::remove(folder / "ground");
  line = std::make_unique<LossyLine>();
  const std::size_t before = heard();
  std::filesystem::create_symlink(line->vehicle(), device);
  std::filesystem::create_symlink(line->ground(), folder / "ground");
  EXPECT_TRUE(eventually([&] { return heard() >= before + 5; }));
  EXPECT_TRUE(eventually([&] { return vehicle_->value("device_openings") >= 2.0; }));
  end();
  EXPECT_EQ(wrong_, 0);
  std::filesystem::remove_all(folder);
}

TEST_F(SerialLink, ACommandThatDoesNotFitIsRefusedAtOnce) {
  LossyLine line;
  start(line.vehicle(), line.ground());
  auto mode = ground_->probe().advertise(topic::mode);
  ground_->probe().every(200ms, [mode](Time) mutable {
    ModeCommand command;
    command.id(std::string(300, 'i'));
    mode.publish(command);
  });
  run();
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return !acks_.empty();
  }));
  end();
  EXPECT_FALSE(acks_.front().accepted());
  EXPECT_THAT(acks_.front().reason(), HasSubstr("does not fit into a frame"));
  EXPECT_TRUE(carried_out_.empty());
}

TEST(SerialLinkParams, AreCheckedWithFileAndLine) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      HostOptions options;
      options.participant.domain = 77;
      Host host(options);
      host.add("serial_link", Config::parse(yaml, "link.yaml"));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("role: ground\ndevice: /dev/ttyUSB7\n"), "");
  EXPECT_THAT(refusal("device: /dev/ttyUSB7\n"), HasSubstr("'role' is missing"));
  EXPECT_THAT(refusal("role: ground\n"), HasSubstr("'device' is missing"));
  EXPECT_THAT(refusal("role: air\ndevice: x\n"), HasSubstr("link.yaml:1: 'role' is vehicle or"));
  EXPECT_THAT(refusal("role: ground\ndevice: x\nbaud: 19201\n"),
              HasSubstr("link.yaml:3: 'baud' is one of 1200"));
  EXPECT_THAT(refusal("role: ground\ndevice: x\nbytes_per_s: 5000\n"), HasSubstr("link.yaml:3"));
}

TEST(SerialLinkParams, AreOfNoUseInLockstep) {
  HostOptions options;
  options.lockstep = true;
  Host host(options);
  EXPECT_THROW(
      host.add("serial_link", Config::parse("role: ground\ndevice: /dev/ttyUSB7\n", "a.yaml")),
      ConfigError);
}

}  // namespace
}  // namespace swiftlet::test
