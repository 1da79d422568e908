// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/topics.hpp"

namespace swiftlet::screen {

/// Asks one thing of a component's parameters at a time, again and again with the same identity
/// until it is answered or a time has passed. Of several instances the first answer counts.
class ParameterAsker {
 public:
  using Request = swiftlet_msgs::msg::ParameterRequest;
  using Reply = swiftlet_msgs::msg::ParameterReply;

  explicit ParameterAsker(Publisher<Request> requests) : requests_(std::move(requests)) {}

  /// Component, command, name and value of `request` count.
  void ask(Request request, Time now);
  /// Whether it is the answer to what was asked.
  bool hear(const Reply& reply);
  /// Sends what is due. True, once, where no answer came in time.
  bool advance(Time now);

 private:
  Publisher<Request> requests_;
  std::optional<Request> request_;
  std::uint64_t count_ = 0;
  Time deadline_{};
  Time next_send_{};
};

}  // namespace swiftlet::screen
