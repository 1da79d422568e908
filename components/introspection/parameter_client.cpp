// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/parameter_client.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <set>

#include "components/runtime/config/nearest_word.hpp"
#include "components/runtime/names.hpp"
#include "components/runtime/stamp.hpp"
#include "components/runtime/topic.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 10ms;
constexpr Duration kResend = 200ms;
/// With the look at the graph before it, less than two seconds.
constexpr Duration kTimeout = 1400ms;

}  // namespace

ParameterClient::ParameterClient(const ComponentContext& context, ParameterQuery query)
    : Observer(context), query_(std::move(query)) {
  requests_ = advertise(topic::parameter_request);
  subscribe(
      topic::parameter_reply, [this](const Reply& reply) { note(reply); }, Need::kOptional);
  every(kTick, [this](Time now) { advance(now); });
}

void ParameterClient::begin(const GraphView& view) {
  // Who reads requests of this vehicle answers for its parameters.
  const std::string wire = wire_topic(vehicle(), topic::parameter_request.name);
  std::set<std::string> running;
  for (const Endpoint& endpoint : view.endpoints) {
    if (endpoint.topic != wire || endpoint.is_writer || endpoint.component.empty()) continue;
    running.insert(endpoint.component);
    if (!query_.component.empty() && endpoint.component != query_.component) continue;
    answers_[{endpoint.component, endpoint.participant}];
  }
  if (answers_.empty()) {
    const std::vector<std::string> names(running.begin(), running.end());
    const std::string near = nearest_word(query_.component, names);
    const std::string subject = query_.component.empty()
                                    ? "nobody here has parameters"
                                    : fmt::format("nobody runs '{}'", query_.component);
    return give_up(fmt::format("{}; {}", subject,
                               names.empty() ? nothing_there(context().domain)
                               : near.empty()
                                   ? fmt::format("running are {}", fmt::join(names, ", "))
                                   : fmt::format("did you mean '{}'?", near)));
  }
  for (const auto& [party, answer] : answers_) {
    Request& request = asked_[party.component];
    request.id(
        fmt::format("param-{}-{}-{}", getpid(), now().time_since_epoch().count(), party.component));
    request.component_name(party.component);
    request.command(query_.command);
    request.name(query_.name);
    request.value(query_.value);
  }
  deadline_ = now() + kTimeout;
}

void ParameterClient::advance(Time now) {
  if (deadline_ == Time{} || finished_) return;
  if (now >= deadline_) return finish();
  if (now < next_send_ || requests_.matched_readers() == 0) return;
  next_send_ = now + kResend;
  for (auto& [component, request] : asked_) {
    request.header(make_header(now, ""));
    requests_.publish(request);
  }
}

void ParameterClient::note(const Reply& reply) {
  const auto asked = asked_.find(reply.component_name());
  if (finished_ || asked == asked_.end() || asked->second.id() != reply.id()) return;
  answers_[{reply.component_name(), reply.process()}] = reply;
  for (const auto& [party, answer] : answers_) {
    if (answer.id().empty()) return;
  }
  finish();
}

void ParameterClient::finish() {
  finished_ = true;
  for (const auto& [party, answer] : answers_) {
    if (answer.id().empty()) {
      silent_.push_back(fmt::format("{} of process {}", party.component, party.process));
    } else {
      replies_.push_back(answer);
    }
  }
  stop(0);
}

}  // namespace swiftlet
