// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/topic_observer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/runtime/names.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

/// Samples that wait while the terminal is slow: a second of the fastest sensor.
constexpr int kDepth = 1024;
constexpr Duration kSilence = 2s;

}  // namespace

TopicObserver::TopicObserver(const ComponentContext& context, std::string topic)
    : Observer(context), topic_(std::move(topic)) {}

void TopicObserver::begin(const GraphView& view) {
  const Result<TopicView> found = find_topic(view, vehicle(), topic_);
  if (!found.ok()) {
    const std::string plain = topic_.substr(topic_[0] == '/' ? 1 : 0);
    if (const Status name = check_name(plain); !name.ok()) {
      return give_up("no topic has such a name: " + name.error().reason, 2);
    }
    return give_up(view.endpoints.empty()
                       ? fmt::format("{}: {}", topic_, nothing_there(context().domain))
                       : found.error().reason);
  }
  found_ = *found;
  if (found_.writers.empty()) {
    return give_up(
        fmt::format("nobody writes '{}'; it is read by {}", found_.name, who(found_.readers)));
  }
  const Endpoint offer = weakest_offers(found_.writers).at(found_.wire);
  if (!open(found_, offer.type)) return;
  QosProfile qos = offer.qos;
  qos.depth = std::max(qos.depth, kDepth);
  for (const Endpoint& writer : found_.writers) {
    if (writer.type != offer.type) {
      log()->warn("{} writes it as {}, which is not heard here", who(writer),
                  ros_type_name(writer.type));
    }
  }
  subscribe_raw(found_.wire, offer.type, qos, [this](const Cdr& cdr) {
    heard_ = true;
    sample(cdr, now());
  });
  call_at(now() + kSilence, [this](Time) { warn_if_silent(); });
}

void TopicObserver::warn_if_silent() {
  if (heard_) return;
  log()->warn("nothing has come on '{}' yet; it is offered by {}", found_.name,
              who(found_.writers));
}

}  // namespace swiftlet
