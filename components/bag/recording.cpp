// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/recording.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "components/bag/recording_records.hpp"
#include "components/bag/recording_state.hpp"

namespace swiftlet {
namespace {

/// Channels, and schemas, that a recording can have.
constexpr std::size_t kMaxIds = 65535;

Repeats repeats_of(const mcap::Reader& file) {
  Repeats repeats;
  const auto part = last_metadata(file, kPartRecord);
  if (!part) return repeats;
  const std::string prefix = kRepeatedKey;
  for (const auto& [key, value] : part->metadata) {
    if (key.compare(0, prefix.size(), prefix) != 0) continue;
    std::istringstream numbers(value);
    for (std::uint32_t number = 0; numbers >> number;) {
      repeats.emplace(key.substr(prefix.size()), number);
    }
  }
  return repeats;
}

/// Names with numbers in them as people count: flight_9 before flight_10.
bool counts_before(const std::string& a, const std::string& b) {
  return std::make_tuple(a.size(), a) < std::make_tuple(b.size(), b);
}

}  // namespace

Result<std::vector<std::filesystem::path>> recording_files(
    const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  for (const auto& path : paths) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
      if (entry.path().extension() == ".mcap") files.push_back(entry.path());
    }
    if (error) return Error{path.string() + ": cannot be read: " + error.message()};
    if (files.size() == before) {
      return Error{path.string() + ": this folder holds no recording (*.mcap)"};
    }
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return counts_before(a.string(), b.string()); });
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

void Recording::State::unite() {
  std::stable_sort(readers.begin(), readers.end(),
                   [](const auto& a, const auto& b) { return begin_of(a) < begin_of(b); });
  begin_with(readers.front());
  for (const mcap::Reader& reader : readers) {
    RecordedFile file;
    if (files.empty()) {
      for (const auto& [id, channel] : channels) file.id[id] = id;
    } else {
      file.repeats = repeats_of(reader);
      add_channels(reader, file);
    }
    count(reader, file);
    files.push_back(std::move(file));
    damage.insert(damage.end(), reader.damage().begin(), reader.damage().end());
  }
  statistics.channel_count = static_cast<std::uint32_t>(channels.size());
  statistics.schema_count = static_cast<std::uint16_t>(schemas.size());
}

Recording::State::Key Recording::State::key_of(const mcap::Reader& reader,
                                               const mcap::Channel& channel) {
  const auto type = reader.schemas().find(channel.schema_id);
  const auto component = channel.metadata.find(kChannelComponentKey);
  return {channel.topic, channel.message_encoding,
          (type == reader.schemas().end() ? "" : type->second.name) +
              (component == channel.metadata.end() ? "" : " of " + component->second)};
}

Recording::State::Key Recording::State::key_of(const mcap::Schema& schema) {
  return {schema.name, schema.encoding, std::string(schema.data.begin(), schema.data.end())};
}

/// The first file's own numbers are kept.
void Recording::State::begin_with(const mcap::Reader& reader) {
  schemas = reader.schemas();
  channels = reader.channels();
  for (const auto& [id, schema] : schemas) schema_ids_.emplace(key_of(schema), id);
  for (const auto& [id, channel] : channels) channel_ids_.emplace(key_of(reader, channel), id);
}

void Recording::State::add_channels(const mcap::Reader& reader, RecordedFile& file) {
  for (const auto& [id, wanted] : reader.channels()) {
    const auto [known, is_new] = channel_ids_.emplace(key_of(reader, wanted), 0);
    if (is_new && channels.size() < kMaxIds) {
      mcap::Channel channel = wanted;
      while (channels.count(channel.id) != 0) ++channel.id;
      channel.schema_id = add_schema(reader, wanted.schema_id);
      known->second = channel.id;
      channels.emplace(channel.id, std::move(channel));
    } else if (is_new) {
      channel_ids_.erase(known);
      damage.push_back(Error{reader.name() + ": topic \"" + wanted.topic +
                             "\" is left out: the files have too many topics together"});
      continue;
    }
    file.id[id] = known->second;
  }
}

std::uint16_t Recording::State::add_schema(const mcap::Reader& reader, std::uint16_t id) {
  const auto wanted = reader.schemas().find(id);
  if (wanted == reader.schemas().end()) return 0;
  const auto [known, is_new] = schema_ids_.emplace(key_of(wanted->second), 0);
  if (is_new && schemas.size() < kMaxIds) {
    mcap::Schema schema = wanted->second;
    while (schema.id == 0 || schemas.count(schema.id) != 0) ++schema.id;
    known->second = schema.id;
    schemas.emplace(schema.id, std::move(schema));
  }
  return known->second;
}

void Recording::State::count(const mcap::Reader& reader, const RecordedFile& file) {
  const mcap::Statistics& more = reader.statistics();
  mcap::Statistics& sum = statistics;
  if (more.message_count > 0) {
    sum.message_start_time = sum.message_count == 0
                                 ? more.message_start_time
                                 : std::min(sum.message_start_time, more.message_start_time);
    sum.message_end_time = std::max(sum.message_end_time, more.message_end_time);
  }
  for (const auto& [id, messages] : more.channel_message_counts) {
    const auto known = file.id.find(id);
    if (known == file.id.end()) continue;
    const std::string& topic = channels.at(known->second).topic;
    const auto repeated = std::count_if(file.repeats.begin(), file.repeats.end(),
                                        [&](const auto& repeat) { return repeat.first == topic; });
    const std::uint64_t own = messages - std::min(messages, static_cast<std::uint64_t>(repeated));
    sum.channel_message_counts[known->second] += own;
    sum.message_count += own;
  }
  sum.attachment_count += more.attachment_count;
  sum.metadata_count += more.metadata_count;
  sum.chunk_count += more.chunk_count;
}

Recording::Recording(mcap::Reader file) {
  auto state = std::make_shared<State>();
  state->name = file.name();
  state->readers.push_back(std::move(file));
  state->unite();
  state_ = std::move(state);
}

Result<Recording> Recording::open(const std::vector<std::filesystem::path>& paths) {
  const auto files = recording_files(paths);
  if (!files.ok()) return files.error();
  auto state = std::make_shared<State>();
  state->name = paths.size() == 1
                    ? paths.front().string()
                    : paths.front().string() + " and " + std::to_string(paths.size() - 1) + " more";
  for (const auto& path : *files) {
    auto reader = mcap::Reader::open(path);
    if (reader.ok()) {
      state->readers.push_back(std::move(*reader));
    } else if (files->size() == 1) {
      return reader.error();
    } else {
      state->damage.push_back(reader.error());
    }
  }
  if (state->readers.empty()) return state->damage.front();
  state->unite();
  return Recording(std::shared_ptr<const State>(std::move(state)));
}

const std::string& Recording::name() const {
  return state_->name;
}
const std::vector<mcap::Reader>& Recording::files() const {
  return state_->readers;
}
const std::map<std::uint16_t, mcap::Schema>& Recording::schemas() const {
  return state_->schemas;
}
const std::map<std::uint16_t, mcap::Channel>& Recording::channels() const {
  return state_->channels;
}
const mcap::Statistics& Recording::statistics() const {
  return state_->statistics;
}
const std::vector<Error>& Recording::damage() const {
  return state_->damage;
}
bool Recording::finished() const {
  return std::all_of(state_->readers.begin(), state_->readers.end(),
                     [](const mcap::Reader& reader) { return reader.finished(); });
}

}  // namespace swiftlet
