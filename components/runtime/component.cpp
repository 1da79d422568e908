// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/component.hpp"

#include <algorithm>

#include "components/runtime/names.hpp"
#include "components/runtime/supervision/supervision.hpp"

namespace swiftlet {

/// Lets nothing through while another instance is the active one, or after the component's end.
class Component::GatedWriter : public Writer {
 public:
  GatedWriter(std::shared_ptr<Writer> writer, std::shared_ptr<const Gate> gate,
              bool also_while_waiting)
      : writer_(std::move(writer)),
        gate_(std::move(gate)),
        also_while_waiting_(also_while_waiting) {}

  void write(const void* message) override {
    if (open()) writer_->write(message);
  }
  void write(const Cdr& cdr) override {
    if (open()) writer_->write(cdr);
  }
  void* loan() override { return open() ? writer_->loan() : nullptr; }
  void write_loan(void* sample) override {
    if (open()) {
      writer_->write_loan(sample);
    } else {
      writer_->discard_loan(sample);
    }
  }
  void discard_loan(void* sample) override { writer_->discard_loan(sample); }
  int matched_readers() const override { return writer_->matched_readers(); }
  bool wait_until_acknowledged(Duration limit) override {
    return writer_->wait_until_acknowledged(limit);
  }

 private:
  bool open() const { return !gate_->halted && (also_while_waiting_ || gate_->active); }

  std::shared_ptr<Writer> writer_;
  std::shared_ptr<const Gate> gate_;
  bool also_while_waiting_;
};

Component::Component(const ComponentContext& context)
    : context_(context),
      log_(logger(context.name)),
      gate_(std::make_shared<Gate>()),
      mailbox_(context.executor->make_mailbox(context.name)) {}

Component::~Component() {
  // First silence the readers, so that nothing is posted any more; then end the thread.
  for (const auto& subscription : subscriptions_) subscription->silence();
  mailbox_.reset();
  supervision_.reset();
}

void Component::supervise(int standby, Duration settle) {
  gate_->active = false;
  supervision_ = std::make_unique<Supervision>(*this, Supervision::Options{standby, settle});
}

void Component::set_active(bool active, Time now) {
  gate_->active = active;
  if (active) on_activated(now);
}

void Component::halt() {
  gate_->halted = true;
  mailbox_->halt();
}

void Component::halt_at(Time time) {
  mailbox_->call_at(time, [this](Time) { halt(); });
}

void Component::sample_rates(Time now) {
  for (SubscriptionTask* input : needed_) input->sample_rate(now);
}

std::vector<InputWatch::Problem> Component::problems(Time now) const {
  std::vector<InputWatch::Problem> problems;
  for (const SubscriptionTask* input : needed_) {
    InputWatch::Problem problem = input->problem(now);
    if (!problem.text.empty()) problems.push_back(std::move(problem));
  }
  if (std::string text = obstacle(); !text.empty()) problems.push_back({std::move(text), true});
  return problems;
}

void Component::every(Duration period, std::function<void(Time)> callback) {
  mailbox_->every(period, std::move(callback));
}

void Component::call_at(Time time, std::function<void(Time)> callback) {
  mailbox_->call_at(time, std::move(callback));
}

std::shared_ptr<Writer> Component::gated(std::shared_ptr<Writer> writer,
                                         bool also_while_waiting) const {
  return std::make_shared<GatedWriter>(std::move(writer), gate_, also_while_waiting);
}

std::shared_ptr<Writer> Component::make_writer(const char* topic, const MessageType& type,
                                               const QosProfile& qos) {
  std::shared_ptr<Writer> writer = context_.participant->make_writer(
      {wire_topic(context_.vehicle, topic), type.dds_name(), qos, context_.name, &type});
  if (context_.faults != nullptr) {
    writer = context_.faults->apply(std::move(writer), topic, &type, *mailbox_, *context_.executor);
  }
  return gated(std::move(writer), false);
}

std::shared_ptr<Writer> Component::make_ungated_writer(const char* topic, const MessageType& type,
                                                       const QosProfile& qos) {
  return gated(context_.participant->make_writer({wire_topic(context_.vehicle, topic),
                                                  type.dds_name(), qos, context_.name, &type}),
               true);
}

std::shared_ptr<Writer> Component::advertise_raw(const std::string& wire_topic,
                                                 const std::string& dds_type,
                                                 const QosProfile& qos) {
  std::shared_ptr<Writer> writer =
      context_.participant->make_writer({wire_topic, dds_type, qos, context_.name, nullptr});
  if (context_.faults != nullptr) {
    writer = context_.faults->apply(std::move(writer), topic_of(context_.vehicle, wire_topic),
                                    nullptr, *mailbox_, *context_.executor);
  }
  return gated(std::move(writer), false);
}

void Component::add_subscription(std::unique_ptr<SubscriptionTask> subscription,
                                 const Input& input) {
  if (input.need == Need::kPeriodic) needed_.push_back(subscription.get());
  listen(std::move(subscription), {wire_topic(context_.vehicle, input.topic), input.type.dds_name(),
                                   input.qos, context_.name, &input.type});
}

void Component::listen(std::unique_ptr<SubscriptionTask> subscription, const EndpointSpec& spec) {
  subscription->listen(*context_.participant, *context_.executor, spec);
  subscriptions_.push_back(std::move(subscription));
}

void Component::SubscriptionTask::listen(Participant& participant, const Executor& executor,
                                         const EndpointSpec& spec) {
  executor_ = &executor;
  reader_ = participant.make_reader(spec, [this, at_once = spec.qos.at_once] { arrived(at_once); });
  // The user's file may have changed it.
  set_limit(reader_->depth());
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
