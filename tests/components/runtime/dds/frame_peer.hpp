// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the frame tests and their other process, frame_peer, have in common.
#pragma once

#include <cstdint>
#include <numeric>
#include <string>

#include "components/runtime/dds/participant.hpp"
#include "components/runtime/plain_types.hpp"

namespace swiftlet::test {

using Frame = swiftlet_frames::msg::Image80k;

inline EndpointSpec frame_spec(const std::string& component) {
  const MessageType& type = message_type<Frame>();
  return {"rt/frame_test", type.dds_name(), qos::bulk, component, &type};
}

/// Every byte of the frame follows from its number.
inline void fill(std::uint32_t number, Frame& frame) {
  frame.info().width(number);
  std::iota(frame.data().begin(), frame.data().end(), static_cast<std::uint8_t>(number));
}

inline bool is_whole(const Frame& frame) {
  auto expected = static_cast<std::uint8_t>(frame.info().width());
  for (const std::uint8_t byte : frame.data()) {
    if (byte != expected++) return false;
  }
  return true;
}

}  // namespace swiftlet::test
