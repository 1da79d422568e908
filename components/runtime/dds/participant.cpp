// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/participant.hpp"

#include <fmt/format.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <system_error>

#include "components/runtime/config/config.hpp"
#include "components/runtime/dds/dds_endpoints.hpp"
#include "components/runtime/dds/dds_log.hpp"
#include "components/runtime/dds/departing_readers.hpp"
#include "components/runtime/dds/discovery_listener.hpp"
#include "components/runtime/dds/endpoint_qos.hpp"
#include "components/runtime/dds/gated_transport.hpp"
#include "components/runtime/dds/shared_memory.hpp"
#include "components/runtime/dds/wire_type.hpp"
#include "components/runtime/log.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

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
class Participant::Impl : public EndpointFactory {
  using Names = std::vector<std::string>;

 public:
  explicit Impl(const ParticipantOptions& options)
      : options_(options),
        graph_([](const Conflict& conflict) { logger("graph")->error(describe(conflict)); }),
        listener_(graph_) {
    bridge_dds_log();
    if (!departing_readers_are_settled()) {
      logger("participant")
          ->warn(
              "Fast DDS may stop for good when a reader leaves: link Swiftlet's runtime into the "
              "program, not into a shared library");
    }
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
  }

  ~Impl() override {
    participant_->set_listener(nullptr);
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  dds::DataWriter* make_writer(const EndpointSpec& spec) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto* overrides = options_.qos_overrides.get();
    dds::DataWriterQos qos = writer_qos(spec, place(spec), overrides);
    if (qos.publish_mode().kind == dds::ASYNCHRONOUS_PUBLISH_MODE && options_.network.pace > 0) {
      qos.publish_mode().flow_controller_name = kPacing;
    }
    Names partitions;
    if (overrides != nullptr) partitions = overrides->writer_partitions(spec.topic, spec.qos.name);
    dds::DataWriter* writer = publisher(partitions)->create_datawriter(topic(spec), qos);
    if (writer == nullptr) {
      throw RuntimeError(fmt::format("cannot write topic '{}'{}", spec.topic, hint(overrides)));
    }
    graph_.add(endpoint(spec, profile_of(qos, spec.qos), writer->guid(), true, partitions));
    return writer;
  }

  dds::DataReader* make_reader(const EndpointSpec& spec,
                               dds::DataReaderListener* listener) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto* overrides = options_.qos_overrides.get();
    const dds::DataReaderQos qos = reader_qos(spec, place(spec), overrides);
    Names partitions;
    if (overrides != nullptr) partitions = overrides->reader_partitions(spec.topic, spec.qos.name);
    dds::DataReader* reader = subscriber(partitions)
                                  ->create_datareader(topic(spec), qos, listener,
                                                      dds::StatusMask::data_available()
                                                          << dds::StatusMask::sample_lost());
    if (reader == nullptr) {
      throw RuntimeError(fmt::format("cannot read topic '{}'{}", spec.topic, hint(overrides)));
    }
    graph_.add(endpoint(spec, profile_of(qos, spec.qos), reader->guid(), false, partitions));
    return reader;
  }

  void remove(dds::DataWriter* writer) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    graph_.remove(id_of(writer->guid()));
    const_cast<dds::Publisher*>(writer->get_publisher())->delete_datawriter(writer);
  }

  void remove(dds::DataReader* reader) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    graph_.remove(id_of(reader->guid()));
    reader->set_listener(nullptr);
    const_cast<dds::Subscriber*>(reader->get_subscriber())->delete_datareader(reader);
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

  EndpointPlace place(const EndpointSpec& spec) {
    const NetworkConfig& network = options_.network;
    const bool leaves = !options_.isolated && (!network.loopback_only() || network.pace > 0);
    return {options_.isolated, shares_memory(spec), leaves};
  }

  static const char* hint(const QosOverrides* overrides) {
    return overrides == nullptr ? "" : "; do the policies of --qos-profiles fit each other?";
  }

  /// One for each set of partitions that is in use.
  dds::Publisher* publisher(const Names& partitions) {
    dds::Publisher*& publisher = publishers_[partitions];
    if (publisher == nullptr) {
      dds::PublisherQos qos = dds::PUBLISHER_QOS_DEFAULT;
      auto names = partitions;
      qos.partition().names(names);
      publisher = participant_->create_publisher(qos);
    }
    return publisher;
  }
  dds::Subscriber* subscriber(const Names& partitions) {
    dds::Subscriber*& subscriber = subscribers_[partitions];
    if (subscriber == nullptr) {
      dds::SubscriberQos qos = dds::SUBSCRIBER_QOS_DEFAULT;
      auto names = partitions;
      qos.partition().names(names);
      subscriber = participant_->create_subscriber(qos);
    }
    return subscriber;
  }

  Endpoint endpoint(const EndpointSpec& spec, const QosProfile& profile, const rtps::GUID_t& guid,
                    bool is_writer, const Names& partitions) const {
    return {id_of(guid), spec.topic,     spec.type,     is_writer,
            profile,     spec.component, options_.name, partitions};
  }

  ParticipantOptions options_;
  std::string id_;
  Graph graph_;
  DiscoveryListener listener_;
  std::mutex mutex_;
  dds::DomainParticipant* participant_ = nullptr;
  std::map<Names, dds::Publisher*> publishers_;
  std::map<Names, dds::Subscriber*> subscribers_;
  std::map<std::string, dds::Topic*> topics_;
  std::optional<SharedMemoryClaim> claim_;
};

Participant::Participant(const ParticipantOptions& options)
    : impl_(std::make_shared<Impl>(options)) {}
Participant::~Participant() = default;

std::unique_ptr<Writer> Participant::make_writer(const EndpointSpec& spec) {
  return make_dds_writer(impl_, spec);
}

std::unique_ptr<Reader> Participant::make_reader(const EndpointSpec& spec,
                                                 std::function<void()> on_sample) {
  return make_dds_reader(impl_, spec, std::move(on_sample));
}

const Graph& Participant::graph() const {
  return impl_->graph();
}

const std::string& Participant::id() const {
  return impl_->id();
}

}  // namespace swiftlet
