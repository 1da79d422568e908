// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the tests read out of recordings.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/mcap/bytes.hpp"
#include "components/runtime/message.hpp"

namespace swiftlet::test {

/// The messages of each topic, in the order of time. Damage is a failure of the test.
std::map<std::string, std::vector<mcap::Bytes>> read_topics(const std::filesystem::path& file);

/// The last message of a topic; a failure of the test where there is none.
template <class T>
T last_message(const std::filesystem::path& file, const std::string& topic);

mcap::Bytes last_bytes(const std::filesystem::path& file, const std::string& topic);

template <class T>
T last_message(const std::filesystem::path& file, const std::string& topic) {
  const mcap::Bytes bytes = last_bytes(file, topic);
  if (bytes.empty()) return {};
  return from_cdr<T>(bytes).value();
}

/// Writes a recording of five seconds in chunks of half a second: 500 messages of odometry at
/// 100 Hz and 50 scans of a round room at 10 Hz.
void write_recording(const std::filesystem::path& file);

}  // namespace swiftlet::test
