// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "components/conversions.hpp"
#include "components/phone_link/phone_params.hpp"
#include "components/phone_link/phone_report.hpp"
#include "components/phone_link/phone_stream.hpp"
#include "components/phone_link/udp_receiver.hpp"
#include "components/runtime/runtime_error.hpp"
#include "components/runtime/supervision/staleness.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kReport = 1s;
constexpr Duration kSilent = 1s;

/// The pose of the vehicle from a phone, over UDP.
class PhoneLink : public Component {
 public:
  explicit PhoneLink(const ComponentContext& context)
      : Component(context),
        params_(read_phone_link(parameters())),
        stream_(params_.stream),
        heard_(kSilent, 1),
        inbox_(*this) {
    if (context.executor->is_lockstep()) {
      throw ConfigError(
          "phone_link reads a socket, which has no simulated time; in a simulation or a replay "
          "leave it out, its topic phone/pose is there");
    }
    pose_ = advertise(topic::phone_pose);
    diagnostics_ = advertise(topic::diagnostics);
    auto socket = UdpSocket::listen(params_.bind);
    if (!socket) throw RuntimeError("phone_link: " + socket.error().reason);
    receiver_ = std::make_unique<UdpReceiver>(
        std::move(socket).value(), [this] { return now(); }, [this] { inbox_.arrived(); });
    log()->info("waits for a phone at {}", to_string(params_.bind));
    every(kReport, [this](Time now) { report(now); });
  }

 private:
  /// What the receiver's thread has noted, taken in the component's own.
  class Inbox : public SampleTask {
   public:
    explicit Inbox(PhoneLink& link) : SampleTask(link.mailbox()), link_(link) {
      set_limit(static_cast<int>(UdpReceiver::kMost));
    }

   private:
    bool take_one() override {
      if (!link_.receiver_->take(datagram_)) return false;
      link_.receive(datagram_);
      return true;
    }
    PhoneLink& link_;
    UdpReceiver::Datagram datagram_;
  };

  void receive(const UdpReceiver::Datagram& datagram) {
    const PhoneStream::Received received =
        stream_.receive(datagram.bytes.data(), datagram.size, datagram.sender, datagram.arrival);
    if (received.clock_restarted && is_worth_a_line(++report_.clock_restarts)) {
      log()->warn("the phone's clock was set, and is learnt anew ({} so far)",
                  report_.clock_restarts);
    }
    if (received.verdict != PhoneVerdict::kAccepted) return note_refused(received, datagram);
    heard_.heard(now());
    if (received.new_phone) {
      log()->info("the phone is {}, session {:08x}", to_string(datagram.sender),
                  received.datagram.session);
    }
    if (received.jump) note_jump(*received.jump);
    publish(received);
  }

  void publish(const PhoneStream::Received& received) {
    geometry_msgs::msg::PoseWithCovarianceStamped message;
    message.header(make_header(received.time, frame::kMap));
    message.pose().pose(to_pose(received.pose.p_WB, received.pose.q_WB));
    using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(message.pose().covariance().data()) = received.pose.covariance;
    pose_.publish(message);
  }

  void note_refused(const PhoneStream::Received& received, const UdpReceiver::Datagram& datagram) {
    last_refusal_ = fmt::format("{}: {}", to_string(received.verdict), received.reason);
    const std::uint64_t count = stream_.count(received.verdict);
    if (!is_worth_a_line(count)) return;
    log()->warn("datagram from {} dropped, {} ({} so far)", to_string(datagram.sender),
                last_refusal_, count);
  }

  void note_jump(const JumpAbsorber::Jump& jump) {
    ++report_.jumps;
    report_.last_jump = jump;
    log()->warn(
        "the phone found itself {:.2f} m and {:.0f} deg elsewhere; the pose follows at "
        "{:.2f} m/s",
        jump.translation.norm(), std::abs(jump.yaw) * 180.0 / M_PI,
        params_.stream.jump.follow_speed);
  }

  void report(Time now) {
    report_.given_up = receiver_->given_up();
    report_.obstacle = why_silent(now);
    diagnostic_msgs::msg::DiagnosticArray message;
    message.header(make_header(now, ""));
    message.status({report_.next(stream_)});
    diagnostics_.publish(message);
  }

  std::string obstacle() const override { return why_silent(now()); }

  std::string why_silent(Time now) const {
    if (const std::string failure = receiver_->failure(); !failure.empty()) return failure;
    if (!heard_.stale(now)) return "";
    if (!last_refusal_.empty()) return fmt::format("no usable pose; last {}", last_refusal_);
    return fmt::format("no phone sends to {}", to_string(params_.bind));
  }

  PhoneLinkParams params_;
  PhoneStream stream_;
  StalenessWatch heard_;
  PhoneReport report_;
  std::string last_refusal_;
  Publisher<geometry_msgs::msg::PoseWithCovarianceStamped> pose_;
  Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
  Inbox inbox_;
  std::unique_ptr<UdpReceiver> receiver_;  // last: its thread uses the others
};

const RegisterComponent<PhoneLink> kRegistered{"phone_link",
                                               "the vehicle's pose from a phone, over UDP"};

}  // namespace
}  // namespace swiftlet
