// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Fast DDS as it comes, with the type support that its generator writes: what Swiftlet is built on.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastdds/dds/core/condition/GuardCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "sensor_msgsPubSubTypes.h"
#include "swiftlet_framesPubSubTypes.h"
#include "tests/bench/middleware/peer.hpp"

namespace swiftlet::bench {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;
using sensor_msgs::msg::Image;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

dds::DomainParticipantQos participant_qos(const std::string& variant) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  qos.transport().use_builtin_transports = false;
  if (has(variant, "shm")) {
    auto shared_memory = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
    shared_memory->segment_size(16 << 20);
    qos.transport().user_transports.push_back(shared_memory);
  }
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  udp->sendBufferSize = udp->receiveBufferSize = 4 << 20;
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t local;
  rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, "127.0.0.1", 0, local);
  qos.wire_protocol().builtin.initialPeersList.push_back(local);
  return qos;
}

template <class Qos>
void apply(const PeerOptions& options, Qos& qos) {
  qos.reliability().kind =
      options.large() ? dds::BEST_EFFORT_RELIABILITY_QOS : dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = options.depth();
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  if (has(options.variant, "plain")) {
    qos.data_sharing().automatic();
  } else {
    qos.data_sharing().off();
  }
}

/// The mark of a message, in the place where each of the two types has it.
Mark mark_of(const Image& image) {
  return {image.header().stamp().sec() * kSecond + image.header().stamp().nanosec(), image.width()};
}
Mark mark_of(const swiftlet_frames::msg::Image1M& frame) {
  return {frame.info().stamp().sec() * kSecond + frame.info().stamp().nanosec(),
          frame.info().width()};
}

template <class T>
class FastDdsPeer : public Peer, private dds::DataReaderListener {
 public:
  FastDdsPeer(const PeerOptions& options, dds::TopicDataType* type) : options_(options) {
    auto* factory = dds::DomainParticipantFactory::get_instance();
    participant_ = factory->create_participant(0, participant_qos(options.variant));
    if (participant_ == nullptr) throw std::runtime_error("no participant");
    const dds::TypeSupport support(type);
    support.register_type(participant_);
    topic_ = participant_->create_topic("bench", support.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    if (options.sends) make_writer();
    if (options.receives) make_reader();
  }

  ~FastDdsPeer() override {
    finished_ = true;
    if (waiter_.joinable()) {
      wake_.set_trigger_value(true);
      waiter_.join();
    }
    if (reader_ != nullptr) reader_->set_listener(nullptr);
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  void publish(const Mark& mark) override {
    if constexpr (std::is_same_v<T, Image>) {
      message_.header().stamp().sec(std::int32_t(mark.sent_ns / kSecond));
      message_.header().stamp().nanosec(std::uint32_t(mark.sent_ns % kSecond));
      message_.width(mark.number);
      writer_->write(&message_);
    } else {
      void* memory = nullptr;
      using Init = dds::DataWriter::LoanInitializationKind;
      if (writer_->loan_sample(memory, Init::NO_LOAN_INITIALIZATION) != ReturnCode_t::RETCODE_OK)
        return;
      T& frame = *static_cast<T*>(memory);
      frame.info().stamp().sec(std::int32_t(mark.sent_ns / kSecond));
      frame.info().stamp().nanosec(std::uint32_t(mark.sent_ns % kSecond));
      frame.info().width(mark.number);
      writer_->write(memory);
    }
  }

  bool matched() override {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count > 0;
  }

 private:
  void make_writer() {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    apply(options_, qos);
    const bool fragments = options_.large() && !options_.receives;
    qos.publish_mode().kind =
        fragments ? dds::ASYNCHRONOUS_PUBLISH_MODE : dds::SYNCHRONOUS_PUBLISH_MODE;
    writer_ =
        participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT)->create_datawriter(topic_, qos);
    if (writer_ == nullptr) throw std::runtime_error("no writer");
    if constexpr (std::is_same_v<T, Image>) {
      message_.encoding("mono8");
      message_.data().resize(options_.bytes);
    }
  }

  void make_reader() {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    apply(options_, qos);
    auto* subscriber = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    const bool waits = has(options_.variant, "waitset");
    reader_ = subscriber->create_datareader(
        topic_, qos, waits ? nullptr : this,
        waits ? dds::StatusMask::none() : dds::StatusMask::data_available());
    if (reader_ == nullptr) throw std::runtime_error("no reader");
    if (waits) waiter_ = std::thread([this] { wait(); });
  }

  void on_data_available(dds::DataReader*) override { take(); }

  void wait() {
    dds::WaitSet set;
    auto& condition = reader_->get_statuscondition();
    condition.set_enabled_statuses(dds::StatusMask::data_available());
    set.attach_condition(condition);
    set.attach_condition(wake_);
    dds::ConditionSeq active;
    while (!finished_) {
      if (set.wait(active, Duration_t(1, 0)) == ReturnCode_t::RETCODE_OK) take();
    }
  }

  void take() {
    dds::SampleInfo info;
    if constexpr (std::is_same_v<T, Image>) {
      while (reader_->take_next_sample(&received_, &info) == ReturnCode_t::RETCODE_OK) {
        if (info.valid_data) options_.on_message(mark_of(received_));
      }
    } else {
      dds::LoanableSequence<T> samples;
      dds::SampleInfoSeq infos;
      while (reader_->take(samples, infos, 1) == ReturnCode_t::RETCODE_OK) {
        if (infos[0].valid_data) options_.on_message(mark_of(samples[0]));
        reader_->return_loan(samples, infos);
      }
    }
  }

  PeerOptions options_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Topic* topic_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  Image message_;
  Image received_;
  std::thread waiter_;
  dds::GuardCondition wake_;
  std::atomic<bool> finished_{false};
};

}  // namespace

const std::vector<std::string>& variants() {
  static const std::vector<std::string> all{"listener-udp", "waitset-udp",    "listener-shm",
                                            "waitset-shm",  "listener-plain", "waitset-plain"};
  return all;
}

std::unique_ptr<Peer> make_peer(const PeerOptions& options) {
  if (has(options.variant, "plain")) {
    if (options.bytes > sizeof(swiftlet_frames::msg::Image1M) || options.bytes < 1'000'000) {
      return nullptr;
    }
    return std::make_unique<FastDdsPeer<swiftlet_frames::msg::Image1M>>(
        options, new swiftlet_frames::msg::Image1MPubSubType);
  }
  return std::make_unique<FastDdsPeer<Image>>(options, new sensor_msgs::msg::ImagePubSubType);
}

}  // namespace swiftlet::bench
