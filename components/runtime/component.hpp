// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/runtime/config.hpp"
#include "components/runtime/executor.hpp"
#include "components/runtime/log.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/participant.hpp"
#include "components/runtime/qos.hpp"

namespace swiftlet {

/// A topic: its name, its type and how it is delivered, in one place for all who use it.
template <class T>
struct Topic {
  const char* name;
  QosProfile qos;
};

/// Sends messages of one topic.
template <class T>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::shared_ptr<Writer> writer) : writer_(std::move(writer)) {}
  void publish(const T& message) { writer_->write(&message); }
  /// Readers that get what is published, in whichever process.
  int matched_readers() const { return writer_->matched_readers(); }

 private:
  std::shared_ptr<Writer> writer_;
};

/// What a component is given to live with.
struct ComponentContext {
  std::string name;     ///< of the component, "estimator"
  std::string vehicle;  ///< "" or the prefix of its topics
  int domain = 0;          ///< DDS domain
  std::shared_ptr<Participant> participant;
  Executor* executor = nullptr;  ///< outlives the component
  Config parameters;             ///< the component's own section
};

/// A part of the stack that talks to others only through topics. It declares in its constructor
/// what it reads and writes:
///
///     subscribe(topic::imu0, [this](const Imu& imu) { ... });
///     every(4ms, [this](Time now) { ... });
///     odometry_ = advertise(topic::odometry);
///
/// Callbacks of one component never run at the same time.
class Component {
 public:
  explicit Component(const ComponentContext& context);
  virtual ~Component();
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  const std::string& name() const { return context_.name; }

 protected:
  template <class T>
  Publisher<T> advertise(const Topic<T>& topic) {
    return Publisher<T>(make_writer(topic.name, message_type<T>(), topic.qos));
  }

  template <class T, class Callback>
  void subscribe(const Topic<T>& topic, Callback callback) {
    add_subscription(std::make_unique<Subscription<T, Callback>>(*mailbox_, std::move(callback)),
                     topic.name, message_type<T>(), topic.qos);
  }

  /// The same for bytes, of types that need not be known: topic and type as on the wire.
  std::shared_ptr<Writer> advertise_raw(const std::string& wire_topic, const std::string& dds_type,
                                        const QosProfile& qos);
  template <class Callback>
  void subscribe_raw(const std::string& wire_topic, const std::string& dds_type,
                     const QosProfile& qos, Callback callback) {
    listen(std::make_unique<RawSubscription<Callback>>(*mailbox_, std::move(callback)),
           {wire_topic, dds_type, qos, name(), nullptr});
  }

  void every(Duration period, std::function<void(Time now)> callback);
  void call_at(Time time, std::function<void(Time now)> callback);
  Time now() const { return context_.executor->now(); }
  /// Ends the whole run.
  void stop(int exit_code) { context_.executor->stop(exit_code); }

  const Config& parameters() const { return context_.parameters; }
  const ComponentContext& context() const { return context_; }
  Mailbox& mailbox() { return *mailbox_; }
  const Logger& log() const { return log_; }

 private:
  /// Takes one sample from its reader and hands it to the component, each time it runs.
  class SubscriptionTask : public Task {
   public:
    explicit SubscriptionTask(Mailbox& mailbox) : mailbox_(mailbox) {}
    void listen(Participant& participant, const EndpointSpec& spec);
    void silence() { reader_.reset(); }
    void run() final;

   protected:
    virtual void dispatch_one(Reader& reader) = 0;

   private:
    Mailbox& mailbox_;
    std::atomic<int> pending_{0};  // runs posted and not begun
    std::unique_ptr<Reader> reader_;
  };

  template <class T, class Callback>
  class Subscription : public SubscriptionTask {
   public:
    Subscription(Mailbox& mailbox, Callback callback)
        : SubscriptionTask(mailbox), callback_(std::move(callback)) {}
    void dispatch_one(Reader& reader) override {
      if (reader.take(&message_)) callback_(std::as_const(message_));
    }

   private:
    T message_;  // kept, so that strings and sequences keep their memory
    Callback callback_;
  };

  template <class Callback>
  class RawSubscription : public SubscriptionTask {
   public:
    RawSubscription(Mailbox& mailbox, Callback callback)
        : SubscriptionTask(mailbox), callback_(std::move(callback)) {}
    void dispatch_one(Reader& reader) override {
      if (reader.take(cdr_)) callback_(std::as_const(cdr_));
    }

   private:
    Cdr cdr_;
    Callback callback_;
  };

  void listen(std::unique_ptr<SubscriptionTask> subscription, const EndpointSpec& spec);
  std::shared_ptr<Writer> make_writer(const char* topic, const MessageType& type,
                                      const QosProfile& qos);
  void add_subscription(std::unique_ptr<SubscriptionTask> subscription, const char* topic,
                        const MessageType& type, const QosProfile& qos);

  ComponentContext context_;
  Logger log_;
  std::unique_ptr<Mailbox> mailbox_;
  std::vector<std::unique_ptr<SubscriptionTask>> subscriptions_;
};

/// The components that this program can host, by name.
class ComponentRegistry {
 public:
  using Factory = std::function<std::unique_ptr<Component>(const ComponentContext&)>;
  struct Entry {
    std::string name;
    std::string summary;
    Factory make;
  };

  static ComponentRegistry& instance();
  void add(Entry entry);
  /// In alphabetical order.
  std::vector<Entry> entries() const;
  const Entry* find(const std::string& name) const;

 private:
  std::vector<Entry> entries_;
};

/// `const RegisterComponent<Estimator> registered{"estimator", "where the vehicle is"};` in the
/// component's source file makes it known by that name.
template <class C>
struct RegisterComponent {
  RegisterComponent(const char* name, const char* summary) {
    ComponentRegistry::instance().add({name, summary, [](const ComponentContext& context) {
                                         return std::make_unique<C>(context);
                                       }});
  }
};

}  // namespace swiftlet
