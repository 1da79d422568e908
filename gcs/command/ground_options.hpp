// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/runtime/command_line.hpp"

namespace swiftlet {

/// A ground station that has come into the vehicle's domain.
struct GroundStation {
  std::string name;  ///< under which it commands
  HostOptions host;  ///< of all that it does there, with one participant
};

/// Where the vehicle is, and who commands it: for all verbs that do more than look.
class GroundOptions : public NetworkOptions {
 public:
  /// NetworkOptions and `--station`.
  void add_to(CLI::App& verb);
  /// The name under which this ground station commands; SWIFTLET_STATION or that of
  /// the host where none was given.
  const std::string& station() const { return station_; }
  /// Comes into the domain, once for all that a verb does there one after another: over a bad link
  /// it takes longest to find each other.
  GroundStation enter() const;

 private:
  static std::string own_name();
  std::string station_ = own_name();
};

}  // namespace swiftlet
