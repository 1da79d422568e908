// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "components/introspection/observer.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

struct ParameterQuery {
  std::string component;     ///< "" for all that run; LIST only
  std::uint8_t command = 0;  ///< of ParameterRequest_Constants
  std::string name;
  std::string value;
};

/// Asks components for their parameters, or to change one, and waits for the answers of all
/// instances. A request has an identity and is repeated with it, so that a bad link can neither
/// lose it nor have it carried out twice.
class ParameterClient : public Observer {
 public:
  using Reply = swiftlet_msgs::msg::ParameterReply;

  ParameterClient(const ComponentContext& context, ParameterQuery query);

  /// By component and process.
  const std::vector<Reply>& replies() const { return replies_; }
  /// "planner of process planner.12" for each instance that did not answer in time.
  const std::vector<std::string>& silent() const { return silent_; }

 private:
  using Request = swiftlet_msgs::msg::ParameterRequest;
  struct Party {
    std::string component;
    std::string process;
    bool operator<(const Party& other) const {
      return std::tie(component, process) < std::tie(other.component, other.process);
    }
  };

  void begin(const GraphView& view) override;
  void advance(Time now);
  void note(const Reply& reply);
  void finish();

  ParameterQuery query_;
  Publisher<Request> requests_;
  std::map<std::string, Request> asked_;  // by component
  std::map<Party, Reply> answers_;        // an empty id: none yet
  Time deadline_{};
  Time next_send_{};
  bool finished_ = false;
  std::vector<Reply> replies_;
  std::vector<std::string> silent_;
};

}  // namespace swiftlet
