// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "components/bag/mcap/records.hpp"

namespace swiftlet {

/// A topic of a recording, as its channel describes it.
struct RecordedTopic {
  std::string name;
  std::string type;             ///< "sensor_msgs/msg/Imu"
  std::string schema_encoding;  ///< "" where the type is not known
  std::string schema;
  std::map<std::string, std::string> metadata;
  bool latched = false;  ///< who comes later needs the last sample, too (transient local)
};

/// One sample on its way from the middleware into a file.
struct RecordedSample {
  std::size_t topic = 0;  ///< as numbered by RecordingWriter::add_topic
  std::uint32_t sequence = 0;
  mcap::Timestamp log_time = 0;           ///< [ns]
  mcap::Timestamp publish_time = 0;       ///< [ns]
  std::array<std::uint8_t, 16> writer{};  ///< GUID of the one who published it
  std::vector<std::uint8_t> data;

  /// What it takes of a bound on memory.
  std::size_t memory() const { return sizeof(*this) + data.capacity() + 32; }
};

}  // namespace swiftlet
