// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/status_observer.hpp"

#include <algorithm>

#include "components/runtime/topic.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr int kDepth = 256;

}  // namespace

StatusObserver::StatusObserver(const ComponentContext& context, Duration listen)
    : Observer(context), listen_(listen) {
  // From the start: while the graph comes to rest, components speak already.
  every(20ms, [this](Time) { look_for_topics(); });
}

void StatusObserver::begin(const GraphView&) {
  call_at(now() + listen_, [this](Time now) {
    last_view_ = view();
    instances_ = book_.all(last_view_, vehicle());
    end_ = now;
    stop(0);
  });
}

void StatusObserver::look_for_topics() {
  const std::string& type = message_type<swiftlet_msgs::msg::ComponentStatus>().dds_name();
  for (const auto& [wire, offer] : weakest_offers(view().endpoints)) {
    std::string of;
    const bool wanted =
        offer.type == type && is_status_topic(wire, &of) && (vehicle().empty() || of == vehicle());
    if (!wanted || !heard_topics_.insert(wire).second) continue;
    QosProfile qos = offer.qos;
    qos.depth = std::max(qos.depth, kDepth);
    subscribe_raw(wire, type, qos,
                  [this, topic = wire](const Cdr& cdr) { book_.note(topic, cdr, now()); });
  }
}

}  // namespace swiftlet
