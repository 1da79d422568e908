// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/participant.hpp"

#include <fmt/format.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <atomic>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <system_error>

#include "components/runtime/config.hpp"
#include "components/runtime/discovery_listener.hpp"
#include "components/runtime/endpoint_qos.hpp"
#include "components/runtime/gated_transport.hpp"
#include "components/runtime/log.hpp"
#include "components/runtime/shared_memory.hpp"
#include "components/runtime/wire_type.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

/// What Fast DDS has to say goes to our log, not to standard output.
class LogBridge : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    const bool is_error = entry.kind == dds::Log::Kind::Error;
    logger("dds")->log(is_error ? spdlog::level::warn : spdlog::level::debug, "{} ({})",
                       entry.message,
                       entry.context.category == nullptr ? "" : entry.context.category);
  }
};

void bridge_log() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<LogBridge>());
  });
}

/// Beyond it the ports of a domain would be above 65535.
constexpr int kLastDomain = 232;

dds::DomainParticipantQos participant_qos(const ParticipantOptions& options, const Gate& gate) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  qos.name(options.name);
  apply(options.network, options.domain, qos);
  for (auto& transport : qos.transport().user_transports) transport = gated(transport, gate);
  if (options.isolated) {
    qos.wire_protocol().builtin.discovery_config.ignoreParticipantFlags =
        static_cast<rtps::ParticipantFilteringFlags_t>(rtps::FILTER_DIFFERENT_HOST |
                                                       rtps::FILTER_DIFFERENT_PROCESS);
  }
  return qos;
}

EndpointGuid binary(const rtps::GUID_t& guid) {
  EndpointGuid bytes;
  const auto after = std::copy_n(guid.guidPrefix.value, guid.guidPrefix.size, bytes.begin());
  std::copy_n(guid.entityId.value, guid.entityId.size, after);
  return bytes;
}

SampleOrigin origin_of(const dds::SampleInfo& info) {
  return {binary(info.sample_identity.writer_guid()),
          info.sample_identity.sequence_number().to64long(),
          Time(Duration(info.source_timestamp.to_ns()))};
}

}  // namespace

std::string endpoint_id(const EndpointGuid& guid) {
  rtps::GUID_t fast;
  std::copy_n(guid.begin(), fast.guidPrefix.size, fast.guidPrefix.value);
  std::copy_n(guid.begin() + fast.guidPrefix.size, fast.entityId.size, fast.entityId.value);
  return id_of(fast);
}

int domain_from_environment() {
  const char* variable = std::getenv("ROS_DOMAIN_ID");
  const std::string text = variable == nullptr ? "" : variable;
  if (text.empty()) return 0;
  const bool is_number = text.size() <= 3 && text.find_first_not_of("0123456789") == text.npos;
  const int domain = is_number ? std::stoi(text) : -1;
  if (domain < 0 || domain > kLastDomain) {
    throw ConfigError(
        fmt::format("ROS_DOMAIN_ID is '{}'; set it to a whole number from 0 to {}, or unset it",
                    text, kLastDomain));
  }
  return domain;
}

/// Everything that Fast DDS gives us for one process, deleted in the reverse order.
class Participant::Impl {
 public:
  explicit Impl(const ParticipantOptions& options)
      : options_(options),
        graph_([](const Conflict& conflict) { logger("graph")->error(describe(conflict)); }),
        listener_(graph_) {
    bridge_log();
    if (!options.isolated) remove_orphaned_segments();
    auto* factory = dds::DomainParticipantFactory::get_instance();
    const auto gate = std::make_shared<std::atomic<bool>>(false);
    participant_ = factory->create_participant(static_cast<dds::DomainId_t>(options.domain),
                                               participant_qos(options, gate), &listener_,
                                               dds::StatusMask::none());
    gate->store(true);  // from here on it hears what others answer
    if (participant_ == nullptr) {
      throw RuntimeError(
          fmt::format("cannot join DDS domain {}: are its UDP ports in use, or is "
                      "none of the interfaces ({}) up?",
                      options.domain, fmt::join(addresses_of(options.network), ", ")));
    }
    id_ = prefix_of(participant_->guid());
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }

  ~Impl() {
    participant_->set_listener(nullptr);
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  dds::DataWriter* make_writer(const EndpointSpec& spec) {
    const std::lock_guard<std::mutex> lock(mutex_);
    dds::DataWriterQos qos = writer_qos(spec, shares_memory(spec), options_.isolated);
    if (qos.publish_mode().kind == dds::ASYNCHRONOUS_PUBLISH_MODE && options_.network.pace > 0) {
      qos.publish_mode().flow_controller_name = kPacing;
    }
    dds::DataWriter* writer = publisher_->create_datawriter(topic(spec), qos);
    if (writer == nullptr) throw RuntimeError(fmt::format("cannot write topic '{}'", spec.topic));
    graph_.add(endpoint(spec, writer->guid(), true));
    return writer;
  }

  dds::DataReader* make_reader(const EndpointSpec& spec, dds::DataReaderListener* listener) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const dds::DataReaderQos qos = reader_qos(spec, shares_memory(spec));
    dds::DataReader* reader = subscriber_->create_datareader(topic(spec), qos, listener,
                                                             dds::StatusMask::data_available()
                                                                 << dds::StatusMask::sample_lost());
    if (reader == nullptr) throw RuntimeError(fmt::format("cannot read topic '{}'", spec.topic));
    graph_.add(endpoint(spec, reader->guid(), false));
    return reader;
  }

  void remove(dds::DataWriter* writer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    graph_.remove(id_of(writer->guid()));
    publisher_->delete_datawriter(writer);
  }

  void remove(dds::DataReader* reader) {
    const std::lock_guard<std::mutex> lock(mutex_);
    graph_.remove(id_of(reader->guid()));
    reader->set_listener(nullptr);
    subscriber_->delete_datareader(reader);
  }

  const Graph& graph() const { return graph_; }
  const std::string& id() const { return id_; }

 private:
  dds::Topic* topic(const EndpointSpec& spec) {
    dds::Topic*& topic = topics_[spec.topic];
    if (topic == nullptr) {
      if (participant_->find_type(spec.type).empty()) {
        participant_->register_type(dds::TypeSupport(new WireType(spec.type)));
      }
      topic = participant_->create_topic(spec.topic, spec.type, dds::TOPIC_QOS_DEFAULT);
    }
    if (topic == nullptr || topic->get_type_name() != spec.type) {
      const std::string other = topic == nullptr ? "nothing" : topic->get_type_name();
      throw RuntimeError(fmt::format("topic '{}' is used as {} and as {} in one process",
                                     spec.topic, ros_type_name(other), ros_type_name(spec.type)));
    }
    return topic;
  }

  /// Plain types are shared with other processes of this machine. The first of them claims the
  /// segments of this process; where that fails, samples are copied as all others are.
  bool shares_memory(const EndpointSpec& spec) {
    const MessageType* type = find_message_type(spec.type);
    if (options_.isolated || !options_.shares_memory || type == nullptr || type->plain_size() == 0)
      return false;
    if (claim_) return true;
    try {
      claim_.emplace(id_);
      return true;
    } catch (const std::system_error& error) {
      logger("dds")->warn("frames of '{}' are copied, not shared: {}", spec.topic, error.what());
      return false;
    }
  }

  Endpoint endpoint(const EndpointSpec& spec, const rtps::GUID_t& guid, bool is_writer) const {
    return {id_of(guid), spec.topic, spec.type, is_writer, spec.qos, spec.component, options_.name};
  }

  ParticipantOptions options_;
  std::string id_;
  Graph graph_;
  DiscoveryListener listener_;
  std::mutex mutex_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  std::map<std::string, dds::Topic*> topics_;
  std::optional<SharedMemoryClaim> claim_;
};

namespace {

/// For messages that must not flood the log.
bool is_power_of_two(std::uint64_t count) {
  return (count & (count - 1)) == 0;
}

template <class Impl>
class DdsWriter : public Writer {
 public:
  DdsWriter(std::shared_ptr<Impl> impl, const EndpointSpec& spec)
      : impl_(std::move(impl)),
        type_(spec.message_type),
        component_(spec.component),
        writer_(impl_->make_writer(spec)) {}
  ~DdsWriter() override { impl_->remove(writer_); }

  void write(const void* message) override {
    WireSample sample;
    sample.type = type_;
    sample.message = message;
    note(writer_->write(&sample));
  }

  void write(const Cdr& cdr) override {
    WireSample sample;
    sample.cdr = &cdr;
    note(writer_->write(&sample));
  }

  void* loan() override {
    void* sample = nullptr;
    const bool lent = writer_->loan_sample(sample) == ReturnCode_t::RETCODE_OK;
    return lent ? sample : nullptr;
  }
  void write_loan(void* sample) override {
    const bool sent = writer_->write(sample);
    if (!sent) writer_->discard_loan(sample);
    note(sent);
  }
  void discard_loan(void* sample) override { writer_->discard_loan(sample); }

  int matched_readers() const override {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }

 private:
  /// What was not sent is said, the 1st, the 2nd, the 4th, ... time.
  void note(bool sent) {
    if (sent || !is_power_of_two(++unsent_)) return;
    logger(component_)
        ->error(
            "a sample of '{}' was not sent ({} so far): a reliable reader does not keep up, or the "
            "memory for samples is used up",
            writer_->get_topic()->get_name(), unsent_);
  }

  std::shared_ptr<Impl> impl_;
  const MessageType* type_;
  std::string component_;
  std::uint64_t unsent_ = 0;
  dds::DataWriter* writer_;
};

template <class Impl>
class DdsReader : public Reader, private dds::DataReaderListener {
 public:
  DdsReader(std::shared_ptr<Impl> impl, const EndpointSpec& spec, std::function<void()> on_sample)
      : impl_(std::move(impl)),
        type_(spec.message_type),
        component_(spec.component),
        on_sample_(std::move(on_sample)),
        reader_(impl_->make_reader(spec, this)) {}
  ~DdsReader() override { impl_->remove(reader_); }

  bool take(void* message, SampleOrigin* origin) override {
    WireSample sample;
    sample.type = type_;
    sample.taken_message = message;
    return take(sample, origin);
  }

  bool take(Cdr& cdr, SampleOrigin* origin) override {
    WireSample sample;
    sample.taken_cdr = &cdr;
    return take(sample, origin);
  }

  bool take_in_place(const std::function<void(const void*)>& use, SampleOrigin* origin) override {
    // The element type does not matter: a loan is a sequence of pointers.
    dds::LoanableSequence<std::uint8_t> samples;
    dds::SampleInfoSeq infos;
    while (reader_->take(samples, infos, 1) == ReturnCode_t::RETCODE_OK) {
      const bool valid = infos[0].valid_data;
      if (valid) {
        note_origin(infos[0], origin);
        use(&samples[0]);
        if (!reader_->is_sample_valid(&samples[0], &infos[0])) note_overwritten();
      }
      reader_->return_loan(samples, infos);
      if (valid) return true;
    }
    return false;
  }

  std::uint64_t overwritten() const override { return overwritten_; }

  int matched_writers() const override {
    dds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return status.current_count;
  }

  std::uint64_t lost() const override { return lost_; }

 private:
  bool take(WireSample& sample, SampleOrigin* origin) {
    dds::SampleInfo info;
    // A sample without data says that a writer is gone; the next may have some.
    while (reader_->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      note_origin(info, origin);
      return true;
    }
    return false;
  }

  static void note_origin(const dds::SampleInfo& info, SampleOrigin* origin) {
    if (origin != nullptr) *origin = origin_of(info);
  }

  void note_overwritten() {
    const std::uint64_t count = ++overwritten_;
    if (!is_power_of_two(count)) return;
    logger(component_)
        ->error(
            "a frame of '{}' was overwritten while it was being read ({} so far): the callback "
            "takes "
            "longer than the writer for its next frames; copy what it needs, or do less in it",
            reader_->get_topicdescription()->get_name(), count);
  }

  void on_data_available(dds::DataReader*) override { on_sample_(); }
  void on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) override {
    lost_ += static_cast<std::uint64_t>(std::max(0, status.total_count_change));
  }

  std::shared_ptr<Impl> impl_;
  const MessageType* type_;
  std::string component_;
  std::function<void()> on_sample_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> overwritten_{0};
  dds::DataReader* reader_;
};

}  // namespace

Participant::Participant(const ParticipantOptions& options)
    : impl_(std::make_shared<Impl>(options)) {}
Participant::~Participant() = default;

std::unique_ptr<Writer> Participant::make_writer(const EndpointSpec& spec) {
  return std::make_unique<DdsWriter<Impl>>(impl_, spec);
}

std::unique_ptr<Reader> Participant::make_reader(const EndpointSpec& spec,
                                                 std::function<void()> on_sample) {
  return std::make_unique<DdsReader<Impl>>(impl_, spec, std::move(on_sample));
}

const Graph& Participant::graph() const {
  return impl_->graph();
}

const std::string& Participant::id() const {
  return impl_->id();
}

}  // namespace swiftlet
