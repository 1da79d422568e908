// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/component.hpp"

#include <algorithm>

#include "components/runtime/names.hpp"

namespace swiftlet {

Component::Component(const ComponentContext& context)
    : context_(context),
      log_(logger(context.name)),
      mailbox_(context.executor->make_mailbox(context.name)) {}

Component::~Component() {
  // First silence the readers, so that nothing is posted any more; then end the thread.
  for (const auto& subscription : subscriptions_) subscription->silence();
  mailbox_.reset();
}

void Component::every(Duration period, std::function<void(Time)> callback) {
  mailbox_->every(period, std::move(callback));
}

void Component::call_at(Time time, std::function<void(Time)> callback) {
  mailbox_->call_at(time, std::move(callback));
}

std::shared_ptr<Writer> Component::make_writer(const char* topic, const MessageType& type,
                                               const QosProfile& qos) {
  return context_.participant->make_writer(
      {wire_topic(context_.vehicle, topic), type.dds_name(), qos, context_.name, &type});
}

std::shared_ptr<Writer> Component::advertise_raw(const std::string& wire_topic,
                                                 const std::string& dds_type,
                                                 const QosProfile& qos) {
  return context_.participant->make_writer({wire_topic, dds_type, qos, context_.name, nullptr});
}

void Component::add_subscription(std::unique_ptr<SubscriptionTask> subscription, const char* topic,
                                 const MessageType& type, const QosProfile& qos) {
  listen(std::move(subscription),
         {wire_topic(context_.vehicle, topic), type.dds_name(), qos, context_.name, &type});
}

void Component::listen(std::unique_ptr<SubscriptionTask> subscription, const EndpointSpec& spec) {
  subscription->listen(*context_.participant, spec);
  subscriptions_.push_back(std::move(subscription));
}

void Component::SubscriptionTask::listen(Participant& participant, const EndpointSpec& spec) {
  // The reader keeps `depth` samples, so more runs than that would find nothing to take.
  reader_ = participant.make_reader(spec, [this, depth = spec.qos.depth] {
    if (pending_.fetch_add(1) < depth) {
      mailbox_.post(*this);
    } else {
      pending_.fetch_sub(1);
    }
  });
}

void Component::SubscriptionTask::run() {
  pending_.fetch_sub(1);
  dispatch_one(*reader_);
}

ComponentRegistry& ComponentRegistry::instance() {
  static ComponentRegistry registry;
  return registry;
}

void ComponentRegistry::add(Entry entry) {
  entries_.push_back(std::move(entry));
}

std::vector<ComponentRegistry::Entry> ComponentRegistry::entries() const {
  std::vector<Entry> sorted = entries_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Entry& a, const Entry& b) { return a.name < b.name; });
  return sorted;
}

const ComponentRegistry::Entry* ComponentRegistry::find(const std::string& name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.name == name; });
  return found == entries_.end() ? nullptr : &*found;
}

}  // namespace swiftlet
