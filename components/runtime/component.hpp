// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "components/runtime/config/config.hpp"
#include "components/runtime/dds/participant.hpp"
#include "components/runtime/execution/executor.hpp"
#include "components/runtime/execution/sample_task.hpp"
#include "components/runtime/loan.hpp"
#include "components/runtime/log.hpp"
#include "components/runtime/message.hpp"
#include "components/runtime/qos.hpp"
#include "components/runtime/supervision/changeable_parameters.hpp"
#include "components/runtime/supervision/faults.hpp"
#include "components/runtime/supervision/input_watch.hpp"
#include "components/runtime/topic.hpp"

namespace swiftlet {

/// Sends messages of one topic.
template <class T>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::shared_ptr<Writer> writer) : writer_(std::move(writer)) {}
  void publish(const T& message) { writer_->write(&message); }
  /// Of plain types: a frame to fill in place, and to publish without a copy.
  Loan<T> loan() {
    static_assert(IsPlain<T>::value, "only plain types can be loaned (runtime/plain_types.hpp)");
    return Loan<T>(writer_);
  }
  void publish(Loan<T>&& loan) { Loan<T>(std::move(loan)).publish(); }
  /// Readers that get what is published, in whichever process.
  int matched_readers() const { return writer_->matched_readers(); }
  /// For a last word: waits until reliable readers have what was published, for `limit` at most.
  bool wait_until_acknowledged(Duration limit) { return writer_->wait_until_acknowledged(limit); }

 private:
  std::shared_ptr<Writer> writer_;
};

class Supervision;

/// What a component is given to live with.
struct ComponentContext {
  std::string name;      ///< of the component, "estimator"
  std::string vehicle;   ///< "" or the prefix of its topics
  std::string process;   ///< as others see it
  std::string instance;  ///< of the component: unique in the domain
  int domain = 0;        ///< DDS domain
  std::shared_ptr<Participant> participant;
  Executor* executor = nullptr;  ///< outlives the component
  FaultPlan* faults = nullptr;   ///< outlives the component
  Config parameters;             ///< the component's own section
};

/// Whether a component can do its work without an input.
enum class Need {
  kPeriodic,  ///< not, if its topic has a period
  kOptional,
};

/// A part of the stack that talks to others only through topics. It declares in its constructor
/// what it reads and writes:
///
///     subscribe(topic::imu0, [this](const Imu& imu) { ... });
///     every(4ms, [this](Time now) { ... });
///     odometry_ = advertise(topic::odometry);
///
/// Callbacks of one component never run at the same time.
///
/// Several instances of a component may run in different processes. All of them hear everything;
/// only the active one is heard: what the others publish goes nowhere. A component that must take
/// something over when it becomes active overrides on_activated().
class Component {
 public:
  explicit Component(const ComponentContext& context);
  virtual ~Component();
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  const std::string& name() const { return context_.name; }

  /// Begins to show that it is alive, and to answer for itself; it publishes from when it is
  /// active. Called once, after construction.
  void supervise(int standby, Duration settle);
  /// From now on it does and says nothing any more, as if its process had been killed.
  void halt();
  /// The same at a later time.
  void halt_at(Time time);

 protected:
  template <class T>
  Publisher<T> advertise(const Topic<T>& topic) {
    return Publisher<T>(
        make_writer(topic.name, message_type<T>(), offered_qos(topic.qos, topic.period)));
  }

  /// Publishes also while another instance is the active one.
  template <class T>
  Publisher<T> advertise_always(const char* topic, const QosProfile& qos) {
    return Publisher<T>(make_ungated_writer(topic, message_type<T>(), qos));
  }

  template <class T, class Callback>
  void subscribe(const Topic<T>& topic, Callback callback, Need need = Need::kPeriodic) {
    add_subscription(std::make_unique<Subscription<T, Callback>>(
                         *mailbox_, InputWatch(topic.name, topic.period), std::move(callback)),
                     {topic.name, message_type<T>(), requested_qos(topic.qos, topic.period), need});
  }

  /// The same for bytes, of types that need not be known: topic and type as on the wire. The
  /// callback may take the sample's origin, too.
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

  /// Whether this is the instance that is heard.
  bool active() const { return gate_->active; }
  /// It takes over from another instance, or begins as the first.
  virtual void on_activated(Time) {}
  /// What keeps it from its work although its inputs come; "" where nothing does.
  virtual std::string obstacle() const { return ""; }

  /// How often others learn that it is alive: three times of it pass before another instance takes
  /// over. Longer than the longest callback. Only in the constructor.
  void set_alive_period(Duration period) { alive_period_ = period; }
  /// Parameters that may be set while it runs. Only in the constructor.
  void set_changeable_parameters(ChangeableParameters parameters) {
    changeable_parameters_ = std::move(parameters);
  }
  /// What is wrong with its inputs at this moment, and its obstacle.
  std::vector<InputWatch::Problem> problems(Time now) const;

  const Config& parameters() const { return context_.parameters; }
  const ComponentContext& context() const { return context_; }
  Mailbox& mailbox() { return *mailbox_; }
  const Logger& log() const { return log_; }

 private:
  friend class Supervision;

  /// Takes samples from its reader and hands them to the component.
  class SubscriptionTask : public SampleTask {
   public:
    using SampleTask::SampleTask;
    void listen(Participant& participant, const Executor& executor, const EndpointSpec& spec);
    void silence() { reader_.reset(); }
    virtual void sample_rate(Time) {}
    virtual InputWatch::Problem problem(Time) const { return {}; }

   protected:
    virtual bool dispatch_one(Reader& reader) = 0;
    Time now() const { return executor_->now(); }
    int matched_writers() const { return reader_->matched_writers(); }

   private:
    bool take_one() final { return dispatch_one(*reader_); }

    const Executor* executor_ = nullptr;
    std::unique_ptr<Reader> reader_;
  };

  template <class T, class Callback>
  class Subscription : public SubscriptionTask {
   public:
    Subscription(Mailbox& mailbox, InputWatch watch, Callback callback)
        : SubscriptionTask(mailbox), watch_(std::move(watch)), callback_(std::move(callback)) {
      const bool in_place = message_type<T>().plain_size() > 0;
      if (!in_place) message_ = std::make_unique<T>();
    }
    bool dispatch_one(Reader& reader) override {
      SampleOrigin origin;
      const auto hand_over = [this, &origin](const void* message) {
        if (watch_.accept(origin.writer, now())) callback_(*static_cast<const T*>(message));
      };
      if (message_ == nullptr) return reader.take_in_place(hand_over, &origin);
      if (!reader.take(message_.get(), &origin)) return false;
      hand_over(message_.get());
      return true;
    }
    void sample_rate(Time now) override { watch_.sample_rate(now); }
    InputWatch::Problem problem(Time now) const override {
      return watch_.problem(now, matched_writers());
    }

   private:
    InputWatch watch_;
    /// Kept, so that strings and sequences keep their memory. None for plain types: the callback
    /// gets the sample where the writer put it.
    std::unique_ptr<T> message_;
    Callback callback_;
  };

  template <class Callback>
  class RawSubscription : public SubscriptionTask {
   public:
    RawSubscription(Mailbox& mailbox, Callback callback)
        : SubscriptionTask(mailbox), callback_(std::move(callback)) {}
    bool dispatch_one(Reader& reader) override {
      SampleOrigin origin;
      if (!reader.take(cdr_, &origin)) return false;
      if constexpr (std::is_invocable_v<Callback, const Cdr&, const SampleOrigin&>) {
        callback_(std::as_const(cdr_), std::as_const(origin));
      } else {
        callback_(std::as_const(cdr_));
      }
      return true;
    }

   private:
    Cdr cdr_;
    Callback callback_;
  };

  struct Input {
    const char* topic;
    const MessageType& type;
    QosProfile qos;
    Need need;
  };
  void listen(std::unique_ptr<SubscriptionTask> subscription, const EndpointSpec& spec);
  void add_subscription(std::unique_ptr<SubscriptionTask> subscription, const Input& input);
  std::shared_ptr<Writer> make_writer(const char* topic, const MessageType& type,
                                      const QosProfile& qos);
  std::shared_ptr<Writer> make_ungated_writer(const char* topic, const MessageType& type,
                                              const QosProfile& qos);
  std::shared_ptr<Writer> gated(std::shared_ptr<Writer> writer, bool also_while_waiting) const;
  void set_active(bool active, Time now);
  void sample_rates(Time now);

  ComponentContext context_;
  Logger log_;
  struct Gate {
    std::atomic<bool> active{true};
    std::atomic<bool> halted{false};
  };
  class GatedWriter;
  std::shared_ptr<Gate> gate_;  // shared with the writers
  Duration alive_period_ = std::chrono::milliseconds(20);
  ChangeableParameters changeable_parameters_;
  std::vector<SubscriptionTask*> needed_;
  std::unique_ptr<Mailbox> mailbox_;
  std::vector<std::unique_ptr<SubscriptionTask>> subscriptions_;
  std::unique_ptr<Supervision> supervision_;
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
