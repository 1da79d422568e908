// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "components/runtime/host.hpp"

namespace CLI {
class App;
}

namespace swiftlet {

/// `--params F.yaml` and `--param component.key=value`, for every verb that hosts components. The
/// file has one section a component:
///
///     planner:
///       max_speed: 1.5
///
/// or is a system file of `swiftlet launch`, which has these sections under `parameters`.
class ParameterOptions {
 public:
  void add_to(CLI::App& verb);

  /// All sections. Throws ConfigError where the file cannot be used or names a component that this
  /// program does not have.
  Config load() const { return load(""); }
  /// The same on top of parameters in YAML that were used before; a file replaces them.
  Config load(const std::string& recorded) const;
  /// Refuses keys that none of the hosted components asked for. What the file has for components
  /// that are hosted elsewhere is theirs.
  static void finish(const Config& parameters, const std::vector<std::string>& hosted);

 private:
  std::string file_;
  std::vector<std::string> values_;
};

/// `--domain`, `--vehicle`, `--network` and the rest of NetworkConfig, and `--qos-profiles`, for
/// every verb that talks to others.
class NetworkOptions {
 public:
  void add_to(CLI::App& verb);
  /// `name` is that of the process as others see it. Waits for the interfaces where that was asked
  /// for.
  HostOptions host_options(const std::string& name) const;

 private:
  int domain_ = -1;
  std::string vehicle_;
  NetworkConfig network_;
  std::string qos_file_;
};

}  // namespace swiftlet
