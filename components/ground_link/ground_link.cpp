// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

#include "components/conversions.hpp"
#include "components/diagnostic_status.hpp"
#include "components/ground_link/coarse_map.hpp"
#include "components/ground_link/link_budget.hpp"
#include "components/ground_link/link_params.hpp"
#include "components/runtime/names.hpp"
#include "components/topics.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 20ms;
constexpr Duration kLookForWriters = 250ms;
constexpr Duration kReport = 1s;
/// Of a datagram: Ethernet, IP, UDP and RTPS headers, and the heartbeat that comes with it [byte].
constexpr double kOverhead = 160.0;
constexpr int kDepth = 32;

/// Carries the listed topics between the vehicle's domain and that of the link to the ground, in
/// both directions and under the same names, within a budget. Nothing else crosses.
class GroundLink : public Component {
 public:
  explicit GroundLink(const ComponentContext& context)
      : Component(context),
        params_(read_ground_link(parameters(), context.domain)),
        link_(std::make_shared<Participant>(link_options(params_))),
        budget_(params_.budget, link_topics(params_)) {
    diagnostics_ = advertise(topic::diagnostics);
    for (const std::string& name : params_.inward) open_inward(name);
    for (const OutwardTopic& topic : params_.outward) outward_.push_back({topic});
    look_for_writers();
    every(kLookForWriters, [this](Time) { look_for_writers(); });
    every(kTick, [this](Time now) { send(now); });
    every(kReport, [this](Time now) { report(now); });
  }

 private:
  struct Outward {
    OutwardTopic settings;
    std::unique_ptr<Writer> writer{};  // null until the vehicle has one
    bool is_map = false;
    LinkCounts reported{};
    bool warned = false;
  };

  /// Commands from the ground, passed on as they come.
  struct Inward : Task {
    std::string name;
    std::shared_ptr<Writer> writer;
    std::unique_ptr<Reader> reader;
    std::uint64_t passed = 0;
    std::uint64_t reported = 0;
    void run() override {
      Cdr message;
      while (reader->take(message)) {
        writer->write(message);
        ++passed;
      }
    }
  };

  static ParticipantOptions link_options(const GroundLinkParams& params) {
    ParticipantOptions options;
    options.name = fmt::format("ground_link.{}", getpid());
    options.domain = params.domain;
    options.network = params.network;
    return options;
  }

  static std::vector<LinkTopic> link_topics(const GroundLinkParams& params) {
    std::vector<LinkTopic> topics;
    for (const OutwardTopic& topic : params.outward) {
      topics.push_back({topic.rate_hz, topic.essential, false});
    }
    return topics;
  }

  void open_inward(const std::string& name) {
    for (const InwardTopic& topic : inward_topics()) {
      if (topic.name != name) continue;
      auto inward = std::make_unique<Inward>();
      const std::string wire = wire_topic(context().vehicle, name);
      inward->name = name;
      inward->writer = advertise_raw(wire, topic.type, topic.qos);
      inward->reader = link_->make_reader({wire, topic.type, topic.qos, this->name(), nullptr},
                                          [this, task = inward.get()] { mailbox().post(*task); });
      inward_.push_back(std::move(inward));
    }
  }

  /// Type and quality of service of a topic are those that the vehicle's writer announces, so that
  /// any topic can be listed.
  void look_for_writers() {
    bool all_found = true;
    for (const Outward& outward : outward_) all_found = all_found && outward.writer != nullptr;
    if (all_found) return;
    const std::vector<Endpoint> endpoints = context().participant->graph().endpoints();
    for (std::size_t i = 0; i < outward_.size(); ++i) {
      if (outward_[i].writer != nullptr) continue;
      const std::string wire = wire_topic(context().vehicle, outward_[i].settings.name);
      for (const Endpoint& endpoint : endpoints) {
        if (!endpoint.is_writer || endpoint.topic != wire) continue;
        open_outward(i, endpoint);
        break;
      }
    }
  }

  void open_outward(std::size_t index, const Endpoint& source) {
    Outward& outward = outward_[index];
    const OutwardTopic& settings = outward.settings;
    outward.is_map = source.type == message_type<nav_msgs::msg::OccupancyGrid>().dds_name();
    if (settings.resolution > 0.0 && !outward.is_map) {
      log()->warn("{}: has no resolution, it is no nav_msgs/msg/OccupancyGrid", settings.name);
    }
    if (source.qos.transient_local) budget_.set_latched(index);
    const bool newest_only = source.qos.transient_local || settings.rate_hz > 0.0;
    // What is not essential is sent by a thread of its own and paced, so that the fragments of a
    // map never keep a status waiting.
    const QosProfile qos{"link", source.qos.reliable, source.qos.transient_local,
                         newest_only ? 1 : kDepth, !settings.essential};
    outward.writer = link_->make_writer({source.topic, source.type, qos, name(), nullptr});
    const QosProfile inner{"link", source.qos.reliable, source.qos.transient_local,
                           source.qos.transient_local ? 1 : kDepth, false};
    subscribe_raw(source.topic, source.type, inner,
                  [this, index](const Cdr& message) { take(index, message); });
  }

  void take(std::size_t index, const Cdr& message) {
    const Outward& outward = outward_[index];
    if (outward.is_map && outward.settings.resolution > 0.0) {
      const auto map = from_cdr<nav_msgs::msg::OccupancyGrid>(message);
      if (!map.ok()) {
        log()->warn("{}: {}", outward.settings.name, map.error().reason);
        return;
      }
      const Cdr coarse = to_cdr(coarsened(*map, outward.settings.resolution));
      budget_.offer(index, coarse, wire_bytes(outward, coarse));
    } else {
      budget_.offer(index, message, wire_bytes(outward, message));
    }
  }

  /// Each reader at the other end gets its own copy.
  double wire_bytes(const Outward& outward, const Cdr& message) const {
    const double datagrams =
        std::ceil(static_cast<double>(message.size()) / params_.network.max_datagram);
    return outward.writer->matched_readers() *
           (static_cast<double>(message.size()) + kOverhead * datagrams);
  }

  void send(Time now) {
    // The link's writers are not the component's own, which wait by themselves.
    if (!active()) return;
    for (const LinkBudget::Departure& departure : budget_.depart(now)) {
      outward_[departure.topic].writer->write(departure.message);
    }
  }

  void report(Time now) {
    using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
    diagnostic_msgs::msg::DiagnosticArray message;
    message.header(make_header(now, ""));
    diagnostic_msgs::msg::DiagnosticStatus total;
    std::uint64_t bytes = 0;
    std::uint64_t over_budget = 0;
    message.status().emplace_back();  // the total comes first
    for (std::size_t i = 0; i < outward_.size(); ++i) {
      const LinkCounts& counts = budget_.counts(i);
      bytes += counts.sent_bytes - outward_[i].reported.sent_bytes;
      over_budget += counts.over_budget - outward_[i].reported.over_budget;
      message.status().push_back(report(outward_[i], counts));
    }
    for (const auto& inward : inward_) {
      diagnostic_msgs::msg::DiagnosticStatus status;
      status.name(fmt::format("ground_link: {}", inward->name));
      status.message("from the ground");
      add_value(status, "messages_per_s", inward->passed - inward->reported);
      inward->reported = inward->passed;
      message.status().push_back(status);
    }
    total.level(over_budget > 0 ? WARN : OK);
    total.name("ground_link");
    total.message(fmt::format("{} of {:.0f} B/s", bytes, params_.budget.bytes_per_s));
    add_value(total, "bytes_per_s", bytes);
    add_value(total, "budget_bytes_per_s", static_cast<std::uint64_t>(params_.budget.bytes_per_s));
    add_value(total, "over_budget_per_s", over_budget);
    message.status().front() = total;
    diagnostics_.publish(message);
  }

  diagnostic_msgs::msg::DiagnosticStatus report(Outward& outward, const LinkCounts& counts) {
    using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
    const LinkCounts before = std::exchange(outward.reported, counts);
    const std::uint64_t over_budget = counts.over_budget - before.over_budget;
    diagnostic_msgs::msg::DiagnosticStatus status;
    status.name(fmt::format("ground_link: {}", outward.settings.name));
    status.level(over_budget > 0 ? WARN : OK);
    status.message(outward.writer == nullptr ? "not heard on the vehicle"
                   : over_budget > 0         ? "thinned: the budget is used up"
                                             : "");
    add_value(status, "bytes_per_s", counts.sent_bytes - before.sent_bytes);
    add_value(status, "messages_per_s", counts.sent - before.sent);
    add_value(status, "thinned_per_s", counts.thinned - before.thinned);
    add_value(status, "over_budget_per_s", over_budget);
    add_value(status, "readers",
              static_cast<std::uint64_t>(
                  outward.writer == nullptr ? 0 : outward.writer->matched_readers()));
    if ((over_budget > 0) != outward.warned) {
      outward.warned = over_budget > 0;
      if (outward.warned) {
        log()->warn("{}: thinned, the budget of {:.0f} B/s is used up", outward.settings.name,
                    params_.budget.bytes_per_s);
      } else {
        log()->info("{}: within the budget again", outward.settings.name);
      }
    }
    return status;
  }

  GroundLinkParams params_;
  std::shared_ptr<Participant> link_;
  LinkBudget budget_;
  std::vector<Outward> outward_;
  std::vector<std::unique_ptr<Inward>> inward_;
  Publisher<diagnostic_msgs::msg::DiagnosticArray> diagnostics_;
};

const RegisterComponent<GroundLink> kRegistered{
    "ground_link", "carries chosen topics to and from the ground station, within a budget"};

}  // namespace
}  // namespace swiftlet
