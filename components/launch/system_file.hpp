// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/runtime/dds/network.hpp"

namespace swiftlet {

/// When a process that crashed is started again.
struct RestartPolicy {
  int max_restarts = 5;      ///< within the window; one more crash, and it is given up
  double window = 60.0;      ///< [s]
  double backoff = 0.1;      ///< before the first restart; doubled for each one in the window [s]
  double max_backoff = 2.0;  ///< [s]
};

/// One process of a host.
struct ProcessSpec {
  std::string name;                     ///< unique on its host
  std::vector<std::string> components;  ///< hosted together; empty for a verb
  std::vector<std::string> verb;        ///< any other verb of the program: {"bag", "record", ...}
  std::vector<std::string> arguments;   ///< on top of those that the file implies
  int standby = 0;                      ///< place in the line of succession
};

/// A Fast DDS discovery server that a host runs for all.
struct DiscoveryServerSpec {
  int id = 0;
  std::string address = "0.0.0.0";
  int port = 11811;
};

struct HostSpec {
  NetworkConfig network;
  std::optional<int> domain;  ///< where it differs from the system's
  std::vector<ProcessSpec> processes;
  std::optional<DiscoveryServerSpec> discovery_server;
};

/// Whether a component is given the scenario of the run.
bool reads_scenario(const std::string& component);

/// What `swiftlet launch` reads: which processes run on which host, with which network.
struct SystemFile {
  std::filesystem::path file;
  std::optional<int> domain;  ///< not given: ROS_DOMAIN_ID, else 0
  std::string vehicle;
  std::filesystem::path scenario;  ///< for the simulators and the pilot; empty where none is needed
  bool has_parameters = false;
  bool stop_on_failure = true;  ///< a process that is given up ends the launch
  double stop_timeout = 5.0;    ///< for a process to end when it is asked to [s]
  RestartPolicy restart;
  std::map<std::string, HostSpec> hosts;

  /// Throws ConfigError: file, line, what is wrong, the nearest known word.
  static SystemFile load(const std::filesystem::path& file);

  /// The host named; else the only one; else the one that is called as this machine is. Throws
  /// ConfigError where there is none.
  const HostSpec& host(const std::string& name) const;
};

/// A process as the operating system starts it.
struct CommandLine {
  std::string name;
  std::vector<std::string> words;
  double pause = 0.0;  ///< at least so long between a crash and the next start [s]
};

/// What runs on `host`, with `program` for the path of swiftlet.
std::vector<CommandLine> command_lines(const SystemFile& system, const HostSpec& host,
                                       const std::string& program);

/// As a shell takes it.
std::string quoted(const std::vector<std::string>& words);

}  // namespace swiftlet
