// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "components/runtime/dds/participant.hpp"
#include "components/runtime/execution/executor.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// One thing that goes wrong, for runs that ask "what if":
///
///     kill estimator@12.5      the component falls silent 12.5 s after the run began
///     delay scan 80ms          messages of the topic arrive 80 ms later
///     drop imu0 20%            one in five of its messages is lost, at random
///     drop imu0 100% @3..4.5   only between 3 and 4.5 s; delay may have a time, too
struct Fault {
  enum class Kind { kKill, kDelay, kDrop };
  Kind kind = Kind::kKill;
  std::string target;  ///< component or topic
  Duration begin{};    ///< since the run began
  Duration end = Duration::max();
  Duration delay{};          ///< of kDelay
  double probability = 0.0;  ///< of kDrop, 0 to 1
};

/// Throws ConfigError, which says how it is written, where `text` cannot be read.
Fault parse_fault(const std::string& text);

/// What goes wrong in one run.
class FaultPlan {
 public:
  FaultPlan() = default;
  FaultPlan(std::vector<Fault> faults, std::uint64_t seed, Time begin)
      : faults_(std::move(faults)), seed_(seed), begin_(begin) {}

  bool empty() const { return faults_.empty(); }
  const std::vector<Fault>& faults() const { return faults_; }
  /// When the faults' own time counts from.
  Time begin() const { return begin_; }

  /// `writer` with what goes wrong on its topic (without prefix: "imu0"); the writer itself where
  /// nothing does. Delayed messages are sent by `mailbox`, which must outlive the writer's use.
  std::shared_ptr<Writer> apply(std::shared_ptr<Writer> writer, const std::string& topic,
                                const MessageType* type, Mailbox& mailbox,
                                const Executor& executor);
  /// Throws ConfigError where a fault has a target that this run does not have, naming the nearest.
  void finish(const std::vector<std::string>& components) const;

 private:
  std::vector<Fault> faults_;
  std::uint64_t seed_ = 0;
  Time begin_{};
  std::set<std::string> topics_;  // that are written in this run
};

}  // namespace swiftlet
