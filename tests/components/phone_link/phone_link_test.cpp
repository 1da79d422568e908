// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The real component on a real socket and real DDS, live.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "components/phone_link/phone_stream.hpp"
#include "components/phone_link/udp_socket.hpp"
#include "components/runtime/runtime_error.hpp"
#include "tests/components/component_bench.hpp"
#include "tests/components/phone_link/phones.hpp"

namespace swiftlet::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A port that nobody has at this moment.
std::uint16_t free_port() {
  for (std::uint16_t port = 18787; port < 19787; ++port) {
    if (UdpSocket::listen({0x7f000001, port}).ok()) return port;
  }
  return 0;
}

HostOptions options(bool lockstep) {
  HostOptions options;
  options.lockstep = lockstep;
  options.participant.domain = 77;
  return options;
}

std::string value_of(const diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key) {
  for (const auto& entry : status.values()) {
    if (entry.key() == key) return entry.value();
  }
  return "";
}

class PhoneLinkTest : public testing::Test {
 protected:
  PhoneLinkTest() : probe_(add()) {
    socket_ = std::make_unique<UdpSocket>(UdpSocket::open().value());
    probe_.subscribe(topic::phone_pose,
                     [this](const geometry_msgs::msg::PoseWithCovarianceStamped& pose) {
                       poses_.push_back(pose);
                       heard_.push_back(probe_.now());
                     });
    probe_.subscribe(topic::diagnostics,
                     [this](const diagnostic_msgs::msg::DiagnosticArray& message) {
                       for (const auto& status : message.status()) {
                         if (status.name() == "phone_link") reports_.push_back(status);
                       }
                     });
  }
  /// Sends a pose each 20 ms until `count` were heard, then waits for `rest`. What is sent before
  /// the component has found out that it is the only one of its kind is not heard.
  void run(std::size_t count, Duration rest) {
    constexpr std::size_t kMost = 1000;
    const auto done = [this, count] { return poses_.size() >= count || sent_.size() >= kMost; };
    probe_.every(20ms, [this, done](Time now) {
      if (!done()) send(now);
    });
    probe_.every(10ms, [this, done, rest](Time now) {
      if (done() && now > sent_.back() + rest) probe_.stop(0);
    });
    ASSERT_EQ(host_.run(), 0);
    ASSERT_GE(poses_.size(), count);
    // From the first on each, once, and as it was sent.
    const std::size_t first = sent_.size() - poses_.size();
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const auto& position = poses_[i].pose().pose().position();
      EXPECT_NEAR(position.x(), 1.0 + 0.01 * static_cast<double>(first + i), 1e-9);
      EXPECT_NEAR(position.z(), 3.0, 1e-9);
    }
    sent_.erase(sent_.begin(), sent_.begin() + static_cast<std::ptrdiff_t>(first));
    sent_before_ = first;
  }
  void send(Time now) {
    PhonePose pose;
    pose.session = 7;
    pose.sequence = static_cast<std::uint32_t>(sent_.size());
    pose.time = now.time_since_epoch();
    pose.position = {0.01 * pose.sequence, 0.0, 0.0};
    sent_.push_back(now);
    send(encode_binary(pose));
    if (hostile_) hostile_(pose);
  }
  void send(const DatagramBytes& bytes) {
    EXPECT_TRUE(socket_->send(bytes.data(), bytes.size(), {0x7f000001, port_}).ok());
  }

  std::uint16_t port_ = free_port();
  Host host_{options(false)};
  Probe& probe_;
  std::unique_ptr<UdpSocket> socket_;
  std::function<void(const PhonePose&)> hostile_;
  std::vector<Time> sent_;
  std::size_t sent_before_ = 0;  // what was heard
  std::vector<Time> heard_;
  std::vector<geometry_msgs::msg::PoseWithCovarianceStamped> poses_;
  std::vector<diagnostic_msgs::msg::DiagnosticStatus> reports_;

 private:
  Probe& add() {
    host_.add("phone_link",
              Config::parse("port: " + std::to_string(port_) + "\nstart: {position: [1, 2, 3]}",
                            "test.yaml"));
    return host_.emplace<Probe>("probe");
  }
};

TEST_F(PhoneLinkTest, APoseIsPublishedWithinAMillisecondOfItsDatagram) {
  ASSERT_NO_FATAL_FAILURE(run(100, 200ms));
  ASSERT_EQ(poses_.size(), sent_.size());
  std::vector<double> delays;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Time stamp = from_msg(poses_[i].header().stamp());
    delays.push_back(to_seconds(heard_[i] - sent_[i]));
    EXPECT_EQ(poses_[i].header().frame_id(), "map");
    EXPECT_GE(stamp, sent_[i] - 1ms);
    EXPECT_LE(stamp, heard_[i]);
  }
  std::sort(delays.begin(), delays.end());
  RecordProperty("median_us", static_cast<int>(1e6 * delays[delays.size() / 2]));
  // The fastest tenth: what it takes when the processor is free, whatever else the machine does.
  EXPECT_LT(delays[delays.size() / 10], 1e-3);
}

TEST_F(PhoneLinkTest, WhatIsNoPoseOfThePhoneIsDroppedAndCounted) {
  auto other = UdpSocket::open().value();
  hostile_ = [&](const PhonePose& pose) {
    PhonePose foreign = pose;
    foreign.session = 8;
    foreign.position.x() = 0.5;
    const DatagramBytes bytes = encode_binary(foreign);
    EXPECT_TRUE(other.send(bytes.data(), bytes.size(), {0x7f000001, port_}).ok());
    send(encode_binary(pose));                         // repeated
    send(bytes_of("GET / HTTP/1.1\r\n\r\n"));          // corrupt
    send(encode_json(pose));                           // not taken unless told
    send(DatagramBytes(kLongestDatagram + 500, 'x'));  // longer than the room for it
  };
  ASSERT_NO_FATAL_FAILURE(run(50, 1500ms));
  const std::size_t all = sent_before_ + sent_.size();
  ASSERT_FALSE(reports_.empty());
  EXPECT_EQ(value_of(reports_.back(), "accepted"), std::to_string(all));
  EXPECT_EQ(value_of(reports_.back(), "foreign"), std::to_string(all));
  EXPECT_EQ(value_of(reports_.back(), "repeated"), std::to_string(all));
  EXPECT_EQ(value_of(reports_.back(), "corrupt"), std::to_string(3 * all));
  EXPECT_EQ(value_of(reports_.back(), "given_up"), "0");
}

TEST_F(PhoneLinkTest, ASecondOneAtTheSamePortIsRefusedByName) {
  EXPECT_THAT(
      [&] { host_.add("phone_link", Config::parse("port: " + std::to_string(port_), "t")); },
      ThrowsMessage<RuntimeError>(HasSubstr("another process does")));
}

TEST(PhoneLink, IsNotForLockstep) {
  Host host(options(true));
  EXPECT_THAT([&] { host.add("phone_link"); },
              ThrowsMessage<ConfigError>(HasSubstr("no simulated time")));
}

}  // namespace
}  // namespace swiftlet::test
