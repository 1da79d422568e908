// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/serial_link/link_frame.hpp"
#include "estimation/basics/result.hpp"
#include "estimation/basics/time.hpp"

namespace swiftlet {

/// Decides which frame goes over a slow line next, so that nothing waits behind what is of no use
/// any more:
///
///   1. an acknowledgement, 2. a command that is due, 3. telemetry, 4. a hello where all is silent.
///
/// Of telemetry only the newest waits. A command is repeated until it is acknowledged, or was not
/// asked for any more for `patience`: it never arrives after its sender gave up. After four others
/// telemetry has its turn, so that a flood of commands does not make the vehicle invisible.
class LinkOutbox {
 public:
  struct Params {
    double bytes_per_s = 1920.0;  ///< that the line carries: 19,200 baud, ten bits a byte
    double repeat = 0.25;         ///< period of a command that is not acknowledged [s]
    double patience = 1.5;        ///< [s]
    double hello = 1.0;           ///< the longest silence [s]
  };
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;
    std::uint64_t outdated = 0;  ///< telemetry that newer telemetry took the place of
    std::uint64_t given_up = 0;  ///< commands that were not acknowledged in time
  };

  explicit LinkOutbox(const Params& params) : params_(params) {}

  using Payload = std::vector<std::uint8_t>;
  /// All refuse what is too long for a frame.
  Status offer_telemetry(Payload payload);
  /// The same id is the same command, however often it is offered.
  Status offer_command(const std::string& id, Payload payload, Time now);
  Status offer_acknowledgement(const std::string& id, Payload payload);
  /// The command with this id has arrived.
  void acknowledged(const std::string& id);

  /// The frame that goes now, as bytes; nothing while the line is busy with those before, or there
  /// is none.
  std::optional<std::vector<std::uint8_t>> next(Time now);
  const Counts& counts() const { return counts_; }
  /// Commands on their way.
  std::size_t commands() const { return commands_.size(); }

 private:
  struct Command {
    std::string id;
    Payload payload;
    Time asked{};  // last
    Time due{};
  };
  struct Acknowledgement {
    std::string id;
    Payload payload;
  };
  std::optional<LinkFrame> choose(Time now);
  std::optional<LinkFrame> choose_urgent(Time now);
  void give_up(Time now);

  Params params_;
  std::vector<Command> commands_;
  std::vector<Acknowledgement> acknowledgements_;
  std::optional<Payload> telemetry_;
  int urgent_in_a_row_ = 0;
  std::uint16_t sequence_ = 0;
  Time free_at_{};
  Time last_sent_{};
  Counts counts_;
};

}  // namespace swiftlet
