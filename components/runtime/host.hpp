// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "components/runtime/component.hpp"

namespace swiftlet {

struct HostOptions {
  ParticipantOptions participant;
  std::string vehicle;  ///< "" or the prefix of all topics
  bool lockstep = false;
  Time start{};     ///< where the clock of a lockstep run begins
  int standby = 0;  ///< place of this process's components in the line of succession
  std::vector<Fault> faults;
  std::uint64_t fault_seed = 0;
  /// Of a host before this one, with the same `participant`; null: the host makes its own.
  std::shared_ptr<Participant> shared;
};

/// A process that hosts components: one participant, one executor, any number of components.
class Host {
 public:
  explicit Host(const HostOptions& options);
  ~Host();

  /// Adds a registered component with its section of the parameters. Throws ConfigError where the
  /// name is not known (naming the nearest that is) or the parameters are refused.
  Component& add(const std::string& name, const Config& parameters = {});
  /// Adds a component of the caller's own class.
  template <class C, class... Args>
  C& emplace(const std::string& name, Args&&... args) {
    auto component = std::make_unique<C>(context(name, {}), std::forward<Args>(args)...);
    C& reference = *component;
    components_.push_back(std::move(component));
    schedule_end(reference);
    return reference;
  }

  /// Runs until a component stops the run or a signal does; returns the exit code. Throws
  /// ConfigError where a fault has a target that this run does not have.
  int run();

  int domain() const { return options_.participant.domain; }
  Executor& executor() { return *executor_; }
  const std::shared_ptr<Participant>& participant() { return participant_; }

 private:
  ComponentContext context(const std::string& name, const Config& parameters);
  void schedule_end(Component& component);

  HostOptions options_;
  FaultPlan faults_;
  std::unique_ptr<Executor> executor_;  // first: from then on signals are noted
  std::shared_ptr<Participant> participant_;
  std::vector<std::unique_ptr<Component>> components_;
};

}  // namespace swiftlet
