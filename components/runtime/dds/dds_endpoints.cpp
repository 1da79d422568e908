// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/dds_endpoints.hpp"

#include <fmt/format.h>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <algorithm>
#include <atomic>
#include <string>

#include "components/runtime/dds/endpoint_qos.hpp"
#include "components/runtime/dds/wire_type.hpp"
#include "components/runtime/execution/stuck_watch.hpp"
#include "components/runtime/log.hpp"

namespace swiftlet {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

EndpointGuid binary(const rtps::GUID_t& guid) {
  EndpointGuid bytes;
  const auto after = std::copy_n(guid.guidPrefix.value, guid.guidPrefix.size, bytes.begin());
  std::copy_n(guid.entityId.value, guid.entityId.size, after);
  return bytes;
}

class DdsWriter : public Writer {
 public:
  DdsWriter(std::shared_ptr<EndpointFactory> factory, const EndpointSpec& spec)
      : factory_(std::move(factory)),
        type_(spec.message_type),
        component_(spec.component),
        what_(fmt::format("writing '{}'", spec.topic)),
        writer_(factory_->make_writer(spec)) {}
  ~DdsWriter() override { factory_->remove(writer_); }

  void write(const void* message) override {
    WireSample sample;
    sample.type = type_;
    sample.message = message;
    note(send(&sample));
  }

  void write(const Cdr& cdr) override {
    WireSample sample;
    sample.cdr = &cdr;
    note(send(&sample));
  }

  void* loan() override {
    void* sample = nullptr;
    const bool lent = writer_->loan_sample(sample) == ReturnCode_t::RETCODE_OK;
    return lent ? sample : nullptr;
  }
  void write_loan(void* sample) override {
    const bool sent = send(sample);
    if (!sent) writer_->discard_loan(sample);
    note(sent);
  }
  void discard_loan(void* sample) override { writer_->discard_loan(sample); }

  int matched_readers() const override {
    const StuckWatch::Inside inside(what_.c_str());
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }

  bool wait_until_acknowledged(Duration limit) override {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(limit);
    const auto rest = static_cast<std::uint32_t>((limit - seconds).count());
    const eprosima::fastrtps::Duration_t wait(static_cast<std::int32_t>(seconds.count()), rest);
    return writer_->wait_for_acknowledgments(wait) == ReturnCode_t::RETCODE_OK;
  }

 private:
  bool send(void* sample) {
    const StuckWatch::Inside inside(what_.c_str());
    return writer_->write(sample);
  }

  void note(bool sent) {
    if (sent || !is_worth_a_line(++unsent_)) return;
    logger(component_)
        ->error(
            "a sample of '{}' was not sent ({} so far): a reliable reader does not keep up, or the "
            "memory for samples is used up",
            writer_->get_topic()->get_name(), unsent_);
  }

  std::shared_ptr<EndpointFactory> factory_;
  const MessageType* type_;
  std::string component_;
  std::string what_;  // as StuckWatch says it
  std::uint64_t unsent_ = 0;
  dds::DataWriter* writer_;
};

class DdsReader : public Reader, private dds::DataReaderListener {
 public:
  DdsReader(std::shared_ptr<EndpointFactory> factory, const EndpointSpec& spec,
            std::function<void()> on_sample)
      : factory_(std::move(factory)),
        type_(spec.message_type),
        component_(spec.component),
        what_(fmt::format("reading '{}'", spec.topic)),
        on_sample_(std::move(on_sample)),
        reader_(factory_->make_reader(spec, this)) {}
  ~DdsReader() override { factory_->remove(reader_); }

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

  int depth() const override { return profile_of(reader_->get_qos(), {}).depth; }

  int matched_writers() const override {
    const StuckWatch::Inside inside(what_.c_str());
    dds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return status.current_count;
  }

  std::uint64_t lost() const override { return lost_; }

 private:
  bool take(WireSample& sample, SampleOrigin* origin) {
    const StuckWatch::Inside inside(what_.c_str());
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
    if (origin == nullptr) return;
    origin->writer = binary(info.sample_identity.writer_guid());
    origin->sequence = info.sample_identity.sequence_number().to64long();
    origin->written = Time(Duration(info.source_timestamp.to_ns()));
  }

  void note_overwritten() {
    const std::uint64_t count = ++overwritten_;
    if (!is_worth_a_line(count)) return;
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

  std::shared_ptr<EndpointFactory> factory_;
  const MessageType* type_;
  std::string component_;
  std::string what_;  // as StuckWatch says it
  std::function<void()> on_sample_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> overwritten_{0};
  dds::DataReader* reader_;
};

}  // namespace

std::unique_ptr<Writer> make_dds_writer(std::shared_ptr<EndpointFactory> factory,
                                        const EndpointSpec& spec) {
  return std::make_unique<DdsWriter>(std::move(factory), spec);
}

std::unique_ptr<Reader> make_dds_reader(std::shared_ptr<EndpointFactory> factory,
                                        const EndpointSpec& spec, std::function<void()> on_sample) {
  return std::make_unique<DdsReader>(std::move(factory), spec, std::move(on_sample));
}

}  // namespace swiftlet
