// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>
#include <optional>

#include "components/command_name.hpp"
#include "components/conversions.hpp"
#include "components/runtime/supervision/staleness.hpp"
#include "components/runtime/utf8.hpp"
#include "components/serial_link/link_report.hpp"
#include "components/serial_link/sequence_watch.hpp"
#include "components/serial_link/serial_link_params.hpp"
#include "components/serial_link/serial_port.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 10ms;
constexpr Duration kReport = 1s;
/// Both ends say something each second.
constexpr Duration kSilent = 3s;
constexpr Duration kFirstRetry = 100ms;
constexpr Duration kLastRetry = 2s;
/// So much is read in one tick, so that a device that talks without end stops nothing else.
constexpr int kReadsAtOnce = 8;
/// Commands that came over the line, whose acknowledgements go back.
constexpr std::size_t kRemembered = 32;

using swiftlet_msgs::msg::CommandAck;
using swiftlet_msgs::msg::ModeCommand;
using swiftlet_msgs::msg::Telemetry;

/// One end of a serial line between a vehicle and its ground station: telemetry comes down,
/// commands go up, and their acknowledgements come back.
class SerialLink : public Component {
 public:
  explicit SerialLink(const ComponentContext& context)
      : Component(context), params_(read_serial_link(parameters())), outbox_(params_.outbox) {
    if (context.executor->is_lockstep()) {
      throw ConfigError(
          "serial_link reads a device, which has no simulated time; in a simulation in lockstep or "
          "a replay leave it out");
    }
    report_.bytes_per_s = params_.outbox.bytes_per_s;
    diagnostics_ = advertise(topic::diagnostics);
    if (params_.role == LinkRole::kVehicle) {
      mode_ = advertise(topic::mode);
      subscribe(topic::telemetry, [this](const Telemetry& telemetry) {
        note(outbox_.offer_telemetry(to_cdr(telemetry)));
      });
      subscribe(topic::mode_ack, [this](const CommandAck& ack) { send_down(ack); });
    } else {
      telemetry_ = advertise(topic::telemetry);
      ack_ = advertise(topic::mode_ack);
      subscribe(topic::mode, [this](const ModeCommand& command) { send_up(command); });
    }
    every(kTick, [this](Time now) { advance(now); });
    every(kReport, [this](Time now) { report(now); });
  }

 private:
  void advance(Time now) {
    if (!active()) return port_.reset();  // a standby leaves the device to the active one
    if (!port_ && now >= next_try_) open(now);
    if (port_) receive(now);
    if (port_) transmit(now);
    tell_silence(heard_.stale(now));
  }

  void tell_silence(bool silent) {
    if (std::exchange(was_silent_, silent) == silent) return;
    if (silent) {
      log()->warn("nothing is heard from the other end");
    } else {
      log()->info("the other end is heard");
    }
  }

  void open(Time now) {
    auto port = SerialPort::open(params_.device, params_.baud);
    if (!port.ok()) {
      if (port.error().reason != problem_) {
        log()->warn("{}; tried again and again", port.error().reason);
      }
      problem_ = port.error().reason;
      return try_later(now);
    }
    port_.emplace(std::move(port).value());
    problem_.clear();
    ++report_.openings;
    decoder_.reset();
    unsent_.clear();
    log()->info("uses {} at {} baud", params_.device, params_.baud);
  }

  void lose(const Error& error, Time now) {
    problem_ = error.reason;
    log()->warn("{}; waits for it to come back", problem_);
    port_.reset();
    try_later(now);
  }

  /// Later each time, until something is read again.
  void try_later(Time now) {
    next_try_ = now + retry_;
    retry_ = std::min(2 * retry_, kLastRetry);
  }

  void receive(Time now) {
    std::uint8_t bytes[512];
    for (int i = 0; i < kReadsAtOnce; ++i) {
      const auto size = port_->read(bytes, sizeof(bytes));
      if (!size.ok()) return lose(size.error(), now);
      if (*size > 0) retry_ = kFirstRetry;
      for (std::size_t at = 0; at < *size; ++at) {
        if (const LinkFrame* frame = decoder_.take(bytes[at])) take(*frame, now);
      }
      if (*size < sizeof(bytes)) return;
    }
  }

  /// The next frame when the one before has left, so that what waits is not old when it goes.
  void transmit(Time now) {
    if (unsent_.empty() && port_->queued() == 0) {
      if (auto frame = outbox_.next(now)) unsent_ = std::move(*frame);
    }
    if (unsent_.empty()) return;
    const auto written = port_->write(unsent_.data(), unsent_.size());
    if (!written.ok()) return lose(written.error(), now);
    unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(*written));
  }

  void take(const LinkFrame& frame, Time now) {
    heard_.heard(now);
    last_heard_ = now;
    sequence_.heard(frame.sequence);
    const bool ground = params_.role == LinkRole::kGround;
    if (frame.type == FrameType::kTelemetry && ground) {
      pass_on<Telemetry>(frame.payload,
                         [this](const Telemetry& telemetry) { telemetry_.publish(telemetry); });
    } else if (frame.type == FrameType::kAcknowledgement && ground) {
      pass_on<CommandAck>(frame.payload, [this](const CommandAck& ack) {
        outbox_.acknowledged(ack.id());
        ack_.publish(ack);
      });
    } else if (frame.type == FrameType::kCommand && !ground) {
      pass_on<ModeCommand>(frame.payload, [this](const ModeCommand& command) {
        remember(command.id());
        mode_.publish(command);
      });
    }
  }

  /// A frame that arrived as it was sent can still be of another version of the program.
  template <class T, class Use>
  void pass_on(const Cdr& payload, Use use) {
    const Result<T> message = from_cdr<T>(payload);
    if (message.ok()) {
      use(*message);
    } else {
      note(Status(Error{message.error().reason + "; are both ends of the same version?"}));
    }
  }

  void send_up(const ModeCommand& command) {
    const Status offered = outbox_.offer_command(command.id(), to_cdr(command), now());
    if (offered.ok()) return;
    CommandAck refusal;
    refusal.header(make_header(now(), frame::kMap));
    refusal.id(command.id());
    refusal.name(command_name(command.command()));
    refusal.station(command.station());
    refusal.reason("serial link: " + offered.error().reason);
    ack_.publish(refusal);
  }

  /// Of others who command the vehicle, the ground does not hear.
  void send_down(CommandAck ack) {
    if (std::find(remembered_.begin(), remembered_.end(), ack.id()) == remembered_.end()) return;
    const std::string reason = std::exchange(ack.reason(), "");
    const std::size_t others = to_cdr(ack).size();
    const std::size_t room = kMaxPayload - std::min(kMaxPayload, others);
    ack.reason(reason.substr(0, utf8_cut(reason, room)));
    note(outbox_.offer_acknowledgement(ack.id(), to_cdr(ack)));
  }

  void remember(const std::string& id) {
    if (std::find(remembered_.begin(), remembered_.end(), id) != remembered_.end()) return;
    remembered_.push_back(id);
    if (remembered_.size() > kRemembered) remembered_.pop_front();
  }

  void note(const Status& status) {
    if (!status.ok() && status.error().reason != std::exchange(noted_, status.error().reason)) {
      log()->warn("{}", status.error().reason);
    }
  }

  void report(Time now) {
    report_.obstacle = problem_;
    report_.silent = heard_.stale(now);
    if (last_heard_) report_.link_age = to_seconds(now - *last_heard_);
    diagnostic_msgs::msg::DiagnosticArray message;
    message.header(make_header(now, ""));
    message.status({report_.next(decoder_.counts(), outbox_.counts(), sequence_.lost())});
    diagnostics_.publish(message);
  }

  std::string obstacle() const override { return problem_; }

  SerialLinkParams params_;
  LinkOutbox outbox_;
  FrameDecoder decoder_;
  SequenceWatch sequence_;
  std::optional<SerialPort> port_;
  std::vector<std::uint8_t> unsent_;  // of the frame that is being sent
  Time next_try_{};
  Duration retry_ = kFirstRetry;
  std::string problem_;
  std::string noted_;
  StalenessWatch heard_{kSilent, 1};
  std::optional<Time> last_heard_;
  bool was_silent_ = true;
  std::deque<std::string> remembered_;
  LinkReport report_;
  Publisher<Telemetry> telemetry_;
  Publisher<ModeCommand> mode_;
  Publisher<CommandAck> ack_;
  Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
};

const RegisterComponent<SerialLink> kRegistered{
    "serial_link", "telemetry down and commands up, over a serial line"};

}  // namespace
}  // namespace swiftlet
