// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Cyclone DDS by its C API, with types that its own compiler makes from our IDL.
#include <dds/dds.h>

#include <cstdlib>
#include <stdexcept>

#include "sensor_msgs.h"
#include "tests/bench/middleware/peer.hpp"

namespace swiftlet::bench {
namespace {

/// Loopback only, found without multicast: as Swiftlet does.
constexpr const char* kConfiguration =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery>"
    "<ParticipantIndex>auto</ParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers>"
    "</Discovery></Domain></CycloneDDS>";

dds_entity_t checked(dds_entity_t entity) {
  if (entity < 0) throw std::runtime_error(dds_strretcode(-entity));
  return entity;
}

class CyclonePeer : public Peer {
 public:
  explicit CyclonePeer(const PeerOptions& options) : options_(options) {
    setenv("CYCLONEDDS_URI", kConfiguration, 0);
    participant_ = checked(dds_create_participant(DDS_DOMAIN_DEFAULT, nullptr, nullptr));
    const dds_entity_t topic = checked(
        dds_create_topic(participant_, &sensor_msgs_msg_Image_desc, "bench", nullptr, nullptr));
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos,
                         options.large() ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
                         DDS_MSECS(20));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, options.depth());
    if (options.sends) {
      writer_ = checked(dds_create_writer(participant_, topic, qos, nullptr));
      data_.resize(options.bytes);
      message_.header.frame_id = empty_;
      message_.encoding = encoding_;
      message_.data._length = message_.data._maximum = std::uint32_t(data_.size());
      message_.data._buffer = data_.data();
    }
    if (options.receives) {
      dds_listener_t* listener = dds_create_listener(this);
      dds_lset_data_available(listener, [](dds_entity_t reader, void* self) {
        static_cast<CyclonePeer*>(self)->take(reader);
      });
      checked(dds_create_reader(participant_, topic, qos, listener));
      dds_delete_listener(listener);
    }
    dds_delete_qos(qos);
  }
  ~CyclonePeer() override { dds_delete(participant_); }

  void publish(const Mark& mark) override {
    message_.header.stamp.sec = std::int32_t(mark.sent_ns / kSecond);
    message_.header.stamp.nanosec = std::uint32_t(mark.sent_ns % kSecond);
    message_.width = mark.number;
    dds_write(writer_, &message_);
  }

  bool matched() override {
    dds_publication_matched_status_t status;
    return dds_get_publication_matched_status(writer_, &status) == 0 && status.current_count > 0;
  }

 private:
  void take(dds_entity_t reader) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) > 0) {
      const auto& image = *static_cast<const sensor_msgs_msg_Image*>(sample);
      if (info.valid_data) {
        options_.on_message(
            {image.header.stamp.sec * kSecond + image.header.stamp.nanosec, image.width});
      }
      dds_return_loan(reader, &sample, 1);
    }
  }

  PeerOptions options_;
  dds_entity_t participant_ = 0;
  dds_entity_t writer_ = 0;
  char empty_[1] = "";
  char encoding_[6] = "mono8";
  std::vector<std::uint8_t> data_;
  sensor_msgs_msg_Image message_{};
};

}  // namespace

const std::vector<std::string>& variants() {
  static const std::vector<std::string> all{"listener"};
  return all;
}

std::unique_ptr<Peer> make_peer(const PeerOptions& options) {
  return std::make_unique<CyclonePeer>(options);
}

}  // namespace swiftlet::bench
