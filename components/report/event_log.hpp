// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace swiftlet {

/// Something that happened at a moment.
struct FlightEvent {
  enum class Level { kInfo, kWarning, kError };
  double time = 0.0;  ///< since the beginning of the recording [s]
  Level level = Level::kInfo;
  std::string kind;  ///< "mode", "command", "guard", ...
  std::string text;
};

/// What happened, by time. Of each kind kMostOfAKind are kept; the others are counted.
class EventLog {
 public:
  static constexpr std::size_t kMostOfAKind = 250;

  void add(double time, FlightEvent::Level level, const std::string& kind, std::string text);

  std::vector<FlightEvent> sorted() const;
  /// How many of each kind are not in the list, by kind.
  const std::map<std::string, std::uint64_t>& left_out() const { return left_out_; }

 private:
  std::vector<FlightEvent> events_;
  std::map<std::string, std::uint64_t> counts_;
  std::map<std::string, std::uint64_t> left_out_;
};

}  // namespace swiftlet
