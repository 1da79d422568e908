// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gcs/command/command_sender.hpp"
#include "gcs/command/ground_options.hpp"

namespace swiftlet {

/// `--patience` of verbs that wait for the vehicle to say something [s].
void add_answer_patience(CLI::App& verb, double& patience);

/// `--wait`, `--json` and `--patience`, for every verb that commands the vehicle.
class CommandOptions {
 public:
  void add_to(CLI::App& verb);
  /// Sends the command, and with `--wait` stays until it is done; says how it went. Throws
  /// CLI::RuntimeError(1) where it was refused, was not answered or has failed.
  void send(const GroundStation& station, const GroundCommand& command) const;
  void send(const GroundOptions& network, const GroundCommand& command) const {
    send(network.enter(), command);
  }
  bool json() const { return json_; }
  double patience() const { return patience_; }  ///< for the vehicle's answer [s]

 private:
  bool wait_ = false;
  bool json_ = false;
  double patience_ = to_seconds(CommandSender::kTimeout);  // [s]
};

}  // namespace swiftlet
