// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "components/bag/mcap/writer.hpp"
#include "components/bag/recording.hpp"
#include "components/runtime/message.hpp"

namespace swiftlet {

/// A channel for CDR of a type that we know, as rosbag2 writes it for a reliable topic.
Result<std::uint16_t> add_topic(mcap::Writer& writer, const std::string& topic,
                                const std::string& type);

/// The bytes of the last message on a topic. Fails where there is none, or where it has another
/// type, and names the file.
Result<Cdr> last_bytes(const Recording& recording, const std::string& topic,
                       const std::string& type);

/// One topic of a file that is being written, with the counter that MCAP wants.
template <class T>
class TopicWriter {
 public:
  Status open(mcap::Writer& writer, const std::string& topic) {
    const auto channel = add_topic(writer, topic, message_type<T>().name());
    if (!channel.ok()) return channel.error();
    channel_ = *channel;
    return {};
  }

  Status write(mcap::Writer& writer, Time time, const T& message) {
    const Cdr cdr = to_cdr(message);
    const mcap::Timestamp stamp = mcap::to_timestamp(time);
    return writer.write(mcap::Message{channel_, count_++, stamp, stamp, cdr});
  }

  std::uint32_t count() const { return count_; }

 private:
  std::uint16_t channel_ = 0;
  std::uint32_t count_ = 0;
};

/// The last message on a topic.
template <class T>
Result<T> last_message(const Recording& recording, const std::string& topic) {
  const auto bytes = last_bytes(recording, topic, message_type<T>().name());
  if (!bytes.ok()) return bytes.error();
  auto message = from_cdr<T>(*bytes);
  if (!message.ok()) {
    return Error{recording.name() + ": " + topic + ": " + message.error().reason};
  }
  return message;
}

}  // namespace swiftlet
