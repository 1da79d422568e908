// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"
#include "components/runtime/supervision/changeable_parameters.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// Answers what others ask of a component's parameters: all that it reads from its configuration
/// are listed, those that it declares changeable may be set while it runs. Knows no middleware.
class ParameterServer {
 public:
  using Reply = swiftlet_msgs::msg::ParameterReply;
  using Request = swiftlet_msgs::msg::ParameterRequest;

  /// `config` after the component has read all of it.
  explicit ParameterServer(const Config& config) : config_(config), entries_(config.entries()) {}

  /// Throws std::invalid_argument where one of the names is none that the component reads.
  void allow(ChangeableParameters changeable);
  /// Without header, component and process. A request that comes again has the answer that it had.
  Reply answer(const Request& request);

 private:
  Reply carry_out(const Request& request);
  std::string set(const ConfigEntry& entry, const std::string& value);
  std::uint8_t changes(const std::string& name) const;

  Config config_;
  std::vector<ConfigEntry> entries_;
  ChangeableParameters changeable_;
  std::deque<Reply> answered_;
};

}  // namespace swiftlet
