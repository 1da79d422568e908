// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>

#include "components/runtime/message.hpp"

namespace swiftlet {

/// What Fast DDS is handed as "data" when a sample is written or taken: either an object of a
/// known type, or the bytes as they are. One of `message` and `cdr` is set.
struct WireSample {
  const MessageType* type = nullptr;
  const void* message = nullptr;
  void* taken_message = nullptr;
  const Cdr* cdr = nullptr;
  Cdr* taken_cdr = nullptr;
};

/// The only TopicDataType of the project. DDS allows one type support for a type name in a
/// participant; with this one, a component can read objects and a recorder bytes of one topic in
/// one process, and types that the IDL files lack can still be recorded and played. Samples of
/// plain types can be loaned: those are handed over as they lie in memory, without a WireSample.
class WireType : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit WireType(const std::string& dds_name);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool is_bounded() const override { return is_plain_; }
  bool is_plain() const override { return is_plain_; }
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle,
              bool force_md5) override;

 private:
  bool is_plain_ = false;
};

}  // namespace swiftlet
