// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// Answers what others ask of a component's parameters: all that it reads from its configuration
/// are listed, those that it declares live may change while it runs. Knows no middleware.
class ParameterServer {
 public:
  using Reply = swiftlet_msgs::msg::ParameterReply;
  using Request = swiftlet_msgs::msg::ParameterRequest;
  /// Uses a configuration in which one live parameter is new, or throws ConfigError or
  /// std::invalid_argument where it cannot be used, with nothing changed.
  using Apply = std::function<void(const Config& changed)>;

  /// `config` after the component has read all of it.
  explicit ParameterServer(const Config& config) : config_(config), entries_(config.entries()) {}

  void allow(std::vector<std::string> live, Apply apply);
  /// Without header, component and process. A request that comes again has the answer that it had.
  Reply answer(const Request& request);

 private:
  Reply carry_out(const Request& request);
  std::string set(const ConfigEntry& entry, const std::string& value);
  bool is_live(const std::string& name) const;

  Config config_;
  std::vector<ConfigEntry> entries_;
  std::vector<std::string> live_;
  Apply apply_;
  std::deque<Reply> answered_;
};

}  // namespace swiftlet
