// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "components/runtime/component.hpp"
#include "components/runtime/supervision/parameter_server.hpp"
#include "components/runtime/supervision/succession.hpp"

namespace swiftlet {

/// What every hosted component does besides its work: it shows that it is alive, says what it
/// misses, takes its place in the line of succession, and answers for its parameters.
///
///     alive/<component>   many times a second, to the other instances and who depends on it
///     component/status    five times a second, with problems, to everybody
///     parameter/...       requests and replies
class Supervision {
 public:
  struct Options {
    int standby = 0;    ///< place in the line of succession
    Duration settle{};  ///< others may be heard for so long before this instance gets active
  };

  /// Of a component whose constructor has run. It must outlive this object.
  Supervision(Component& component, const Options& options);
  /// Takes its leave, so that nobody waits for it.
  ~Supervision();
  Supervision(const Supervision&) = delete;
  Supervision& operator=(const Supervision&) = delete;

 private:
  void show_life(Time now);
  void publish_status(Time now);
  swiftlet_msgs::msg::ComponentStatus status(Time now) const;
  void answer(const swiftlet_msgs::msg::ParameterRequest& request);

  Component& component_;
  Succession succession_;
  ParameterServer parameters_;
  Publisher<swiftlet_msgs::msg::ComponentStatus> alive_;
  Publisher<swiftlet_msgs::msg::ComponentStatus> status_;
  Publisher<swiftlet_msgs::msg::ParameterReply> reply_;
};

}  // namespace swiftlet
