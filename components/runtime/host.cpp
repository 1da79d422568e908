// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/host.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "components/runtime/supervision/node_announcer.hpp"

namespace swiftlet {

using namespace std::chrono_literals;

namespace {

ParticipantOptions participant_options(const HostOptions& options) {
  ParticipantOptions participant = options.participant;
  participant.isolated = participant.isolated || options.lockstep;
  return participant;
}

/// How long a component listens for others of its name before it is the active one. Nobody else is
/// there in lockstep; a standby lets the first in line come up.
Duration settle_time(const HostOptions& options) {
  if (options.lockstep || options.participant.isolated) return Duration(0);
  return 500ms + options.standby * 1s;
}

}  // namespace

Host::Host(const HostOptions& options)
    : options_(options),
      executor_(options.lockstep ? make_lockstep_executor(options.start) : make_live_executor()),
      participant_(options.shared != nullptr
                       ? options.shared
                       : std::make_shared<Participant>(participant_options(options))) {
  faults_ = FaultPlan(options.faults, options.fault_seed, executor_->now());
  // In lockstep nobody else is there to see.
  if (!options.lockstep) emplace<NodeAnnouncer>("node_announcer");
}

Host::~Host() {
  // Components refer to executor and participant: they go first, the last one first.
  while (!components_.empty()) components_.pop_back();
}

Component& Host::add(const std::string& name, const Config& parameters) {
  const auto& registry = ComponentRegistry::instance();
  const ComponentRegistry::Entry* entry = registry.find(name);
  if (entry == nullptr) {
    std::vector<std::string> known;
    for (const auto& known_entry : registry.entries()) known.push_back(known_entry.name);
    const std::string near = nearest_word(name, known);
    throw ConfigError(fmt::format("unknown component '{}'; {}", name,
                                  near.empty()
                                      ? fmt::format("this program has {}", fmt::join(known, ", "))
                                      : fmt::format("did you mean '{}'?", near)));
  }
  try {
    components_.push_back(entry->make(context(name, parameters)));
  } catch (const std::invalid_argument& error) {
    // Each value was in its range, but the algorithm cannot work with all of them together.
    throw ConfigError(fmt::format("{}: the parameters cannot be used: {}", name, error.what()));
  }
  Component& component = *components_.back();
  component.supervise(options_.standby, settle_time(options_));
  schedule_end(component);
  return component;
}

int Host::run() {
  std::vector<std::string> names;
  for (const auto& component : components_) names.push_back(component->name());
  faults_.finish(names);
  return executor_->run();
}

void Host::schedule_end(Component& component) {
  for (const Fault& fault : faults_.faults()) {
    if (fault.kind != Fault::Kind::kKill || fault.target != component.name()) continue;
    component.halt_at(faults_.begin() + fault.begin);
  }
}

ComponentContext Host::context(const std::string& name, const Config& parameters) {
  ComponentContext context;
  context.name = name;
  context.vehicle = options_.vehicle;
  // Nothing that differs between two runs gets into the messages of a lockstep run.
  context.process = options_.lockstep ? "lockstep" : options_.participant.name;
  context.instance = options_.lockstep ? "lockstep" : participant_->id();
  context.domain = options_.participant.domain;
  context.participant = participant_;
  context.executor = executor_.get();
  context.faults = &faults_;
  context.parameters = parameters;
  return context;
}

}  // namespace swiftlet
