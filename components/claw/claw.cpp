// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <stdexcept>

#include "components/conversions.hpp"
#include "components/topics.hpp"
#include "control/claw_controller.hpp"

namespace swiftlet {
namespace {

ClawController make_controller(const Config& config) {
  ClawController::Params params;
  config.read("pulse_open_us", params.pulse_open_us);
  config.read("pulse_closed_us", params.pulse_closed_us);
  config.read("tolerance_us", params.tolerance_us);
  config.read("travel_time", params.travel_time, {0.05, 60.0});
  config.read("current_limit", params.current_limit);
  config.read("stall_current", params.stall_current);
  config.read("stall_time", params.stall_time, {0.02, 5.0});
  config.read("holding_current", params.holding_current);
  config.read("holding_gain_us", params.holding_gain_us);
  config.read("patience", params.patience, {0.05, 60.0});
  config.read("feedback_timeout", params.feedback_timeout, {0.06, 5.0});
  try {
    return ClawController(params);
  } catch (const std::invalid_argument& error) {
    config.fail("", error.what());
  }
}

std::uint8_t to_msg(ClawController::State state) {
  using namespace swiftlet_msgs::msg::ClawState_Constants;
  switch (state) {
    case ClawController::State::kUnknown:
      return UNKNOWN;
    case ClawController::State::kOpening:
      return OPENING;
    case ClawController::State::kOpen:
      return OPEN;
    case ClawController::State::kClosing:
      return CLOSING;
    case ClawController::State::kClosed:
      return CLOSED;
    case ClawController::State::kHolding:
      return HOLDING;
    case ClawController::State::kFault:
      return FAULT;
  }
  return UNKNOWN;
}

/// The claw under the vehicle. A standby hears the same and computes the same, so that it holds
/// what is held when it takes over.
class Claw : public Component {
 public:
  explicit Claw(const ComponentContext& context)
      : Component(context), controller_(make_controller(parameters())) {
    servo_ = advertise(topic::claw_servo);
    state_ = advertise(topic::claw_state);
    subscribe(topic::claw_command, [this](const swiftlet_msgs::msg::ClawCommand& command) {
      controller_.command(command.open(), now());
    });
    subscribe(topic::claw_feedback, [this](const swiftlet_msgs::msg::ServoFeedback& feedback) {
      controller_.set_feedback(static_cast<double>(feedback.pulse_us()),
                               static_cast<double>(feedback.current()), now());
    });
    every(topic::claw_servo.period, [this](Time now) { move(now); });
    every(topic::claw_state.period, [this](Time now) { tell(now); });
  }

 private:
  void move(Time now) {
    const ClawController::State before = controller_.state();
    if (const auto pulse = controller_.tick(now)) {
      swiftlet_msgs::msg::ServoCommand command;
      command.stamp(swiftlet::to_msg(now));
      command.pulse_us(static_cast<float>(*pulse));
      servo_.publish(command);
    }
    if (controller_.state() == before) return;
    if (controller_.state() == ClawController::State::kFault) {
      log()->warn("{}", controller_.reason());
    }
    tell(now);
  }

  void tell(Time now) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const auto opening = controller_.opening(now);
    const auto current = controller_.current(now);
    swiftlet_msgs::msg::ClawState state;
    state.header(make_header(now, frame::kBody));
    state.state(to_msg(controller_.state()));
    state.opening(opening ? static_cast<float>(*opening) : kNan);
    state.current(current ? static_cast<float>(*current) : kNan);
    state.reason(controller_.reason());
    state_.publish(state);
  }

  ClawController controller_;
  Publisher<swiftlet_msgs::msg::ServoCommand> servo_;
  Publisher<swiftlet_msgs::msg::ClawState> state_;
};

const RegisterComponent<Claw> kRegistered{"claw", "opens and closes the claw, and holds with it"};

}  // namespace
}  // namespace swiftlet
