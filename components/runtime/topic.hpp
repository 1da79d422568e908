// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/runtime/qos.hpp"
#include "estimation/basics/time.hpp"
#include "swiftlet_msgs.h"

namespace swiftlet {

/// A topic: its name, its type, how it is delivered, and how often, in one place for all who use
/// it.
template <class T>
struct Topic {
  const char* name;
  QosProfile qos;
  /// The longest time between two messages while all is well. One writer is heard at a time, and
  /// one that was silent for three periods is as good as dead. Zero: no such time, messages come
  /// from anybody when there is something to say.
  Duration period{0};
};

/// A slow periodic topic offers three of its periods as DDS deadline, so that a ROS 2 reader that
/// asks for one can match; ours ask for none, they have their own clock for that. Fast topics offer
/// none: the deadline timer more than doubles the cost of a message.
constexpr QosProfile offered_qos(const QosProfile& qos, Duration period) {
  constexpr Duration kSlow = std::chrono::milliseconds(100);
  QosProfile offered = qos;
  if (period >= kSlow && qos.deadline == kUnlimited) offered.deadline = 3 * period;
  return offered;
}

/// A reader of a fast periodic topic asks for best effort, whatever the writer offers. The next
/// sample is there long before a lost one could be sent again, and a reliable reader holds back all
/// that came after a lost sample: at 5 % loss, setpoints at 100 Hz stood still for up to 0.3 s.
constexpr QosProfile requested_qos(const QosProfile& qos, Duration period) {
  constexpr Duration kFast = std::chrono::milliseconds(20);
  QosProfile requested = qos;
  if (period > Duration(0) && period <= kFast) requested.reliable = false;
  return requested;
}

/// `subscribe(at_once(topic::imu0), ...)`: the callback may run in the thread of the middleware
/// that brought the message, without the change of threads, when nothing else of the component runs
/// or waits. Still no two callbacks of a component run at the same time; a lockstep run knows no
/// difference. For short callbacks: what comes next over the network waits for them meanwhile. Such
/// a callback makes no readers and writers, blocks nowhere, and does not read a topic that its
/// component itself writes. One that takes long is named in the log.
template <class T>
constexpr Topic<T> at_once(Topic<T> topic) {
  topic.qos.at_once = true;
  return topic;
}

/// Topics of the runtime itself, which every component has.
namespace topic {

inline constexpr Topic<swiftlet_msgs::msg::ComponentStatus> component_status{"component/status",
                                                                             qos::state};
inline constexpr Topic<swiftlet_msgs::msg::ParameterRequest> parameter_request{"parameter/request",
                                                                               qos::command};
inline constexpr Topic<swiftlet_msgs::msg::ParameterReply> parameter_reply{"parameter/reply",
                                                                           qos::command};

/// Name of the topic on which the instances of one component see each other live: ComponentStatus
/// without problems, many times a second.
inline std::string alive_name(const std::string& component) {
  return "alive/" + component;
}
/// How signs of life are delivered: the newest counts.
inline constexpr QosProfile alive_qos = qos::sensor;

}  // namespace topic
}  // namespace swiftlet
