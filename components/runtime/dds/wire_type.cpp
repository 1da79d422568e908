// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/wire_type.hpp"

#include <algorithm>

namespace swiftlet {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

namespace {

/// A first guess for payload buffers; they grow to what a sample needs.
constexpr std::uint32_t kTypicalSize = 512;
constexpr std::uint32_t kEncapsulation = 4;

std::size_t size_of(const WireSample& sample) {
  return sample.cdr != nullptr ? sample.cdr->size() : sample.type->serialized_size(sample.message);
}

}  // namespace

WireType::WireType(const std::string& dds_name) {
  setName(dds_name.c_str());
  const MessageType* type = find_message_type(dds_name);
  is_plain_ = type != nullptr && type->plain_size() > 0;
  m_typeSize =
      is_plain_ ? kEncapsulation + static_cast<std::uint32_t>(type->plain_size()) : kTypicalSize;
  m_isGetKeyDefined = false;
}

bool WireType::serialize(void* data, SerializedPayload_t* payload) {
  const auto& sample = *static_cast<const WireSample*>(data);
  const std::size_t size = size_of(sample);
  if (size < 4 || size > payload->max_size) return false;
  if (sample.cdr != nullptr) {
    std::copy(sample.cdr->begin(), sample.cdr->end(), payload->data);
    payload->length = static_cast<std::uint32_t>(size);
  } else {
    payload->length =
        static_cast<std::uint32_t>(sample.type->serialize(sample.message, payload->data, size));
  }
  const bool big_endian = payload->data[1] == 0;
  payload->encapsulation = big_endian ? CDR_BE : CDR_LE;
  return payload->length > 0;
}

bool WireType::deserialize(SerializedPayload_t* payload, void* data) {
  auto& sample = *static_cast<WireSample*>(data);
  if (sample.taken_cdr != nullptr) {
    sample.taken_cdr->assign(payload->data, payload->data + payload->length);
    return true;
  }
  return sample.type->deserialize(payload->data, payload->length, sample.taken_message);
}

std::function<std::uint32_t()> WireType::getSerializedSizeProvider(void* data) {
  const auto* sample = static_cast<const WireSample*>(data);
  return [sample] { return static_cast<std::uint32_t>(size_of(*sample)); };
}

void* WireType::createData() {
  return new WireSample;
}
void WireType::deleteData(void* data) {
  delete static_cast<WireSample*>(data);
}
bool WireType::getKey(void*, InstanceHandle_t*, bool) {
  return false;
}

}  // namespace swiftlet
