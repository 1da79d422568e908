// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/conversions.hpp"
#include "components/sim/claw_servo.hpp"
#include "components/sim/scenario.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

ClawServo::Params claw_of(const Config& parameters) {
  std::string file;
  parameters.require("scenario", file);
  const Scenario scenario = Scenario::load(file);
  if (!scenario.claw) {
    parameters.fail("scenario", "the scenario has no claw; add 'claw: {}' to it");
  }
  return *scenario.claw;
}

/// The simulated servo of a claw, in place of its driver. Without a pulse it stays where it is.
class SimClaw : public Component {
 public:
  explicit SimClaw(const ComponentContext& context)
      : Component(context), servo_(claw_of(parameters())) {
    feedback_ = advertise(topic::claw_feedback);
    // A servo is left alone until somebody tells the claw something.
    subscribe(
        topic::claw_servo,
        [this](const swiftlet_msgs::msg::ServoCommand& command) {
          servo_.set_pulse(static_cast<double>(command.pulse_us()));
        },
        Need::kOptional);
    every(topic::claw_feedback.period, [this](Time now) {
      servo_.step(topic::claw_feedback.period);
      swiftlet_msgs::msg::ServoFeedback feedback;
      feedback.stamp(to_msg(now));
      feedback.pulse_us(static_cast<float>(servo_.position_us()));
      feedback.current(static_cast<float>(servo_.current()));
      feedback_.publish(feedback);
    });
  }

 private:
  ClawServo servo_;
  Publisher<swiftlet_msgs::msg::ServoFeedback> feedback_;
};

const RegisterComponent<SimClaw> kRegistered{"sim_claw", "the simulated servo of a claw"};

}  // namespace
}  // namespace swiftlet
