// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/host.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace swiftlet {
namespace {

ParticipantOptions participant_options(const HostOptions& options) {
  ParticipantOptions participant = options.participant;
  participant.isolated = participant.isolated || options.lockstep;
  return participant;
}

}  // namespace

Host::Host(const HostOptions& options)
    : vehicle_(options.vehicle),
      domain_(options.participant.domain),
      executor_(options.lockstep ? make_lockstep_executor(options.start) : make_live_executor()),
      participant_(std::make_shared<Participant>(participant_options(options))) {}

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
  return *components_.back();
}

ComponentContext Host::context(const std::string& name, const Config& parameters) {
  return {name, vehicle_, domain_, participant_, executor_.get(), parameters};
}

}  // namespace swiftlet
