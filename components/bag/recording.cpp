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

namespace swiftlet {
namespace {

/// Channels, and schemas, that a recording can have.
constexpr std::size_t kMaxIds = 65535;

/// Topic and sequence number of messages that a part has from the parts before it.
using Repeats = std::set<std::pair<std::string, std::uint32_t>>;

std::optional<mcap::Metadata> last_metadata(const mcap::Reader& file, const std::string& name) {
  std::optional<mcap::Metadata> last;
  for (const mcap::MetadataIndex& index : file.metadata()) {
    if (index.name != name) continue;
    auto read = file.read(index);
    if (read.ok()) last = std::move(*read);
  }
  return last;
}

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

mcap::Timestamp begin_of(const mcap::Reader& file) {
  mcap::Timestamp begin = file.statistics().message_start_time;
  for (const mcap::ChunkIndex& chunk : file.chunks()) {
    if (chunk.message_start_time > 0) begin = std::min(begin, chunk.message_start_time);
  }
  return begin;
}

/// Names with numbers in them as people count: flight_9 before flight_10.
bool counts_before(const std::string& a, const std::string& b) {
  return std::make_tuple(a.size(), a) < std::make_tuple(b.size(), b);
}

struct File {
  Repeats repeats;                            // that are left out
  std::map<std::uint16_t, std::uint16_t> id;  // of a channel of the recording, by that in the file
};

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

struct Recording::State {
  std::string name;
  std::vector<mcap::Reader> readers;
  std::vector<File> files;
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
  void add_channels(const mcap::Reader& reader, File& file);
  std::uint16_t add_schema(const mcap::Reader& reader, std::uint16_t id);
  void count(const mcap::Reader& reader, const File& file);

  std::map<Key, std::uint16_t> channel_ids_;
  std::map<Key, std::uint16_t> schema_ids_;
};

void Recording::State::unite() {
  std::stable_sort(readers.begin(), readers.end(),
                   [](const auto& a, const auto& b) { return begin_of(a) < begin_of(b); });
  begin_with(readers.front());
  for (const mcap::Reader& reader : readers) {
    File file;
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
  return {channel.topic, channel.message_encoding,
          type == reader.schemas().end() ? "" : type->second.name};
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

void Recording::State::add_channels(const mcap::Reader& reader, File& file) {
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

void Recording::State::count(const mcap::Reader& reader, const File& file) {
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

namespace {

/// The messages of one file, one ahead.
struct Source {
  mcap::MessageCursor cursor;
  Repeats repeats;  // still to come
  mcap::Timestamp begin = 0;
  std::optional<mcap::MessageView> head;
  bool ended = false;
};

}  // namespace

struct RecordingCursor::Impl {
  std::shared_ptr<const Recording::State> state;
  std::vector<Source> sources;
  std::optional<std::size_t> given;  // whose message was handed out last

  Status fill(std::size_t index);
  Result<std::optional<mcap::MessageView>> next();
};

Status RecordingCursor::Impl::fill(std::size_t index) {
  Source& source = sources[index];
  const auto& ids = state->files[index].id;
  while (!source.head && !source.ended) {
    auto next = source.cursor.next();
    if (!next.ok()) return next.error();
    if (!*next) {
      source.ended = true;
      return {};
    }
    mcap::MessageView view = **next;
    if (source.repeats.erase({view.channel->topic, view.message.sequence}) > 0) continue;
    const auto id = ids.find(view.channel->id);
    if (id == ids.end()) continue;
    const auto channel = state->channels.find(id->second);
    const auto schema = state->schemas.find(channel->second.schema_id);
    view.channel = &channel->second;
    view.schema = schema == state->schemas.end() ? nullptr : &schema->second;
    view.message.channel_id = channel->first;
    source.head = view;
  }
  return {};
}

Result<std::optional<mcap::MessageView>> RecordingCursor::Impl::next() {
  if (given) sources[*given].head.reset();
  given.reset();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    // A file whose time has not come is not read yet.
    const bool is_early = given && sources[*given].head->message.log_time < sources[i].begin;
    if (is_early) continue;
    if (const Status filled = fill(i); !filled.ok()) {
      given.reset();
      return filled.error();
    }
    if (!sources[i].head) continue;
    if (!given || sources[i].head->message.log_time < sources[*given].head->message.log_time) {
      given = i;
    }
  }
  return given ? sources[*given].head : std::optional<mcap::MessageView>();
}

RecordingCursor::RecordingCursor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingCursor::RecordingCursor(RecordingCursor&&) noexcept = default;
RecordingCursor& RecordingCursor::operator=(RecordingCursor&&) noexcept = default;
RecordingCursor::~RecordingCursor() = default;

Result<std::optional<mcap::MessageView>> RecordingCursor::next() {
  return impl_->next();
}

RecordingCursor Recording::messages(const mcap::Filter& filter) const {
  auto impl = std::make_unique<RecordingCursor::Impl>();
  impl->state = state_;
  for (std::size_t i = 0; i < state_->readers.size(); ++i) {
    const mcap::Reader& reader = state_->readers[i];
    impl->sources.push_back(
        {reader.messages(filter), state_->files[i].repeats, begin_of(reader), {}, false});
  }
  return RecordingCursor(std::move(impl));
}

std::optional<LossLedger> losses_of(const Recording& recording) {
  std::optional<LossLedger> sum;
  for (const mcap::Reader& file : recording.files()) {
    const auto record = last_metadata(file, kLossRecord);
    const auto ledger = record ? ledger_of(*record) : std::nullopt;
    if (!ledger) continue;
    if (!sum) sum.emplace();
    add(*sum, *ledger);
  }
  return sum;
}

std::optional<mcap::Metadata> metadata_named(const Recording& recording, const std::string& name) {
  for (const mcap::Reader& file : recording.files()) {
    if (auto found = last_metadata(file, name)) return found;
  }
  return std::nullopt;
}

std::vector<std::string> missing_parts(const Recording& recording) {
  std::set<unsigned long> parts;
  for (const mcap::Reader& file : recording.files()) {
    const auto record = last_metadata(file, kPartRecord);
    if (!record) continue;
    const auto number = record->metadata.find("part");
    if (number == record->metadata.end()) continue;
    parts.insert(std::strtoul(number->second.c_str(), nullptr, 10));
  }
  std::vector<std::string> missing;
  unsigned long expected = 0;
  for (const unsigned long part : parts) {
    if (part > expected) {
      missing.push_back(recording.name() + ": of the recording's parts, " +
                        (part == expected + 1 ? "part " + std::to_string(expected) + " is missing"
                                              : "parts " + std::to_string(expected) + " to " +
                                                    std::to_string(part - 1) + " are missing"));
    }
    expected = part + 1;
  }
  return missing;
}

}  // namespace swiftlet
