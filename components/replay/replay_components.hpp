// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "components/replay/recorded_events.hpp"
#include "components/runtime/component.hpp"
#include "components/runtime/reflection/type_library.hpp"

namespace swiftlet {

/// The first output that is not as it was recorded.
struct ReplayDifference {
  Time time{};
  std::string topic;
  std::string field;  ///< "pose.pose.position.x"; "" for a message without counterpart
  std::string recorded;
  std::string replayed;
};

/// What came out of a replay, beside the recording.
struct ReplayResult {
  std::uint64_t compared = 0;   ///< outputs that had a recorded counterpart
  std::uint64_t different = 0;  ///< of these, or without counterpart
  std::map<std::string, std::uint64_t> different_by_topic;
  std::optional<ReplayDifference> first;
  std::string hash;  ///< of all outputs: topics, times, bytes
};

/// What the two components of a replay share.
struct ReplayState {
  RecordedEvents events;
  Time time{};                          // of the outputs counted below
  std::map<std::string, int> produced;  // outputs at that time, by topic
};

/// Publishes the recorded inputs in lockstep, each batch at its time, and after the outputs that
/// were recorded before it. Made before the components that hear it, as their sources were.
class ReplaySource : public Component, private EventSource {
 public:
  /// Topics that are not CDR of a named type, or whose name DDS cannot carry, are left out with a
  /// warning.
  ReplaySource(const ComponentContext& context, const Recording& recording,
               std::shared_ptr<ReplayState> state);

  std::size_t topics() const { return writers_.size(); }

 private:
  std::optional<Time> next() const override;
  bool before_timers() const override;
  void happen() override;

  std::shared_ptr<ReplayState> state_;
  std::map<std::string, std::shared_ptr<Writer>> writers_;  // by topic as recorded
};

/// Takes the outputs and compares them with the recorded ones. Made last, as a recorder is.
class ReplayComparison : public Component {
 public:
  /// `outputs`: type on the wire by topic. What `source` writes on them is none.
  ReplayComparison(const ComponentContext& context, std::shared_ptr<ReplayState> state,
                   const std::map<std::string, std::string>& outputs, const std::string& source);

  /// After the run.
  ReplayResult result() const;

 private:
  void take(const std::string& topic, const std::string& type, const Cdr& cdr);
  void note(const ReplayDifference& difference);

  bool is_from_source(const EndpointGuid& writer);

  std::shared_ptr<ReplayState> state_;
  std::string source_;
  std::map<EndpointGuid, bool> from_source_;
  ReplayResult result_;
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;  // FNV-1a
};

}  // namespace swiftlet
