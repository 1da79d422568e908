// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/runtime/command_line.hpp"

namespace swiftlet {

/// Where the vehicle is, and who commands it: for all verbs that do more than look.
class GroundOptions : public NetworkOptions {
 public:
  /// NetworkOptions and `--station`.
  void add_to(CLI::App& verb);
  /// The name under which this ground station commands; SWIFTLET_STATION or that of
  /// the host where none was given.
  const std::string& station() const { return station_; }

 private:
  static std::string own_name();
  std::string station_ = own_name();
};

}  // namespace swiftlet
