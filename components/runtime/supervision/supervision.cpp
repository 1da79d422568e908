// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/supervision.hpp"

#include "components/runtime/stamp.hpp"
#include "components/runtime/topic.hpp"

namespace swiftlet {

using namespace std::chrono_literals;
using swiftlet_msgs::msg::ComponentStatus;

namespace {

constexpr Duration kStatusPeriod = 200ms;

Succession::Sign sign_of(const ComponentStatus& status) {
  return {status.instance(), static_cast<int>(status.standby()), status.active(), status.term()};
}

}  // namespace

Supervision::Supervision(Component& component, const Options& options)
    : component_(component),
      succession_({component.context().instance, options.standby, false, 0},
                  component.alive_period_, options.settle, component.now()),
      parameters_(component.parameters()) {
  parameters_.allow(component.changeable_parameters_);
  alive_ = component.advertise_always<ComponentStatus>(topic::alive_name(component.name()).c_str(),
                                                       topic::alive_qos);
  status_ = component.advertise_always<ComponentStatus>(topic::component_status.name,
                                                        topic::component_status.qos);
  reply_ = component.advertise_always<swiftlet_msgs::msg::ParameterReply>(
      topic::parameter_reply.name, topic::parameter_reply.qos);
  const std::string alive = topic::alive_name(component.name());
  component.subscribe(Topic<ComponentStatus>{alive.c_str(), topic::alive_qos},
                      [this](const ComponentStatus& status) {
                        succession_.heard(sign_of(status), component_.now());
                      });
  component.subscribe(
      topic::parameter_request,
      [this](const swiftlet_msgs::msg::ParameterRequest& request) { answer(request); });
  component.every(component.alive_period_, [this](Time now) { show_life(now); });
  component.every(kStatusPeriod, [this](Time now) { publish_status(now); });
  if (options.settle == Duration(0)) show_life(component.now());
}

Supervision::~Supervision() {
  ComponentStatus farewell = status(component_.now());
  farewell.active(false);
  alive_.publish(farewell);
  status_.publish(farewell);
}

void Supervision::show_life(Time now) {
  if (succession_.update(now)) {
    component_.set_active(succession_.active(), now);
    publish_status(now);
  }
  alive_.publish(status(now));
}

void Supervision::publish_status(Time now) {
  component_.sample_rates(now);
  ComponentStatus message = status(now);
  for (const InputWatch::Problem& problem : component_.problems(now)) {
    message.problems().push_back(problem.text);
    message.blocked(message.blocked() || problem.missing);
  }
  status_.publish(message);
}

ComponentStatus Supervision::status(Time now) const {
  ComponentStatus message;
  message.header(make_header(now, ""));
  message.component_name(component_.name());
  message.process(component_.context().process);
  message.instance(succession_.self().instance);
  message.standby(static_cast<std::uint32_t>(succession_.self().standby));
  message.active(succession_.active());
  message.term(succession_.self().term);
  message.period(to_seconds(component_.alive_period_));
  return message;
}

void Supervision::answer(const swiftlet_msgs::msg::ParameterRequest& request) {
  if (request.component_name() != component_.name()) return;
  swiftlet_msgs::msg::ParameterReply reply = parameters_.answer(request);
  reply.header(make_header(component_.now(), ""));
  reply.component_name(component_.name());
  reply.process(component_.context().process);
  reply_.publish(reply);
}

}  // namespace swiftlet
