// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "components/bag/recording.hpp"

/// What the parts of Recording share.
namespace swiftlet {

/// Topic and sequence number of messages that a part has from the parts before it.
using Repeats = std::set<std::pair<std::string, std::uint32_t>>;

/// What a file of a recording adds to what the reader knows.
struct RecordedFile {
  Repeats repeats;                            // that are left out
  std::map<std::uint16_t, std::uint16_t> id;  // of a channel of the recording, by that in the file
};

struct Recording::State {
  std::string name;
  std::vector<mcap::Reader> readers;
  std::vector<RecordedFile> files;
  std::map<std::uint16_t, mcap::Schema> schemas;
  std::map<std::uint16_t, mcap::Channel> channels;
  mcap::Statistics statistics;
  std::vector<Error> damage;

  void unite();

 private:
  using Key = std::array<std::string, 3>;
  static Key key_of(const mcap::Reader& reader, const mcap::Channel& channel);
  static Key key_of(const mcap::Schema& schema);
  void begin_with(const mcap::Reader& reader);
  void add_channels(const mcap::Reader& reader, RecordedFile& file);
  std::uint16_t add_schema(const mcap::Reader& reader, std::uint16_t id);
  void count(const mcap::Reader& reader, const RecordedFile& file);

  std::map<Key, std::uint16_t> channel_ids_;
  std::map<Key, std::uint16_t> schema_ids_;
};

/// The earliest log time in a file.
mcap::Timestamp begin_of(const mcap::Reader& file);

std::optional<mcap::Metadata> last_metadata(const mcap::Reader& file, const std::string& name);

}  // namespace swiftlet
