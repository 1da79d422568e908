// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>
#include <utility>

#include "components/bag/mcap/file_layout.hpp"

namespace swiftlet::mcap {
namespace {

/// A message of a run, by its record: in the decompressed chunk, or in the file.
struct Entry {
  Timestamp log_time = 0;
  RawRecord record;
};

/// Messages by log time that come from one chunk, or all those outside of chunks.
struct Run {
  std::uint64_t file_offset = 0;  // of the chunk
  bool in_file = false;           // outside of chunks: `records` is empty
  Bytes records;                  // decompressed
  std::vector<Entry> entries;
  std::size_t at = 0;

  const Entry& entry() const { return entries[at]; }
  auto key() const {
    const std::uint64_t place = in_file ? entry().record.offset : file_offset;
    return std::make_tuple(entry().log_time, place, entry().record.offset);
  }
};

bool comes_later(const std::unique_ptr<Run>& a, const std::unique_ptr<Run>& b) {
  return b->key() < a->key();
}

void sort_by_time(std::vector<Entry>& entries) {
  const auto earlier = [](const Entry& a, const Entry& b) { return a.log_time < b.log_time; };
  if (std::is_sorted(entries.begin(), entries.end(), earlier)) return;
  std::stable_sort(entries.begin(), entries.end(), earlier);
}

}  // namespace

struct MessageCursor::Impl {
  std::shared_ptr<const Reader::State> state;
  Filter filter;
  std::vector<bool> wanted;                // by channel id
  std::vector<const ChunkIndex*> pending;  // chunks to come, the next one last
  std::vector<std::unique_ptr<Run>> heap;  // runs with messages left, the earliest in front
  std::unique_ptr<Run> current;            // whose message was handed out last
  std::unique_ptr<Run> spare;              // memory to use again
  std::uint64_t memory = 0;                // of the runs in use [bytes]
  Bytes content;

  bool in_time(Timestamp time) const { return filter.first <= time && time <= filter.last; }

  bool is_wanted(const ChunkIndex& chunk) const {
    if (chunk.message_end_time < filter.first || chunk.message_start_time > filter.last) {
      return false;
    }
    if (chunk.message_index_offsets.empty()) return true;  // nothing says what is in it
    return std::any_of(chunk.message_index_offsets.begin(), chunk.message_index_offsets.end(),
                       [this](const auto& channel) { return wanted[channel.first]; });
  }

  void start();
  void add_loose_messages();
  Status load(const ChunkIndex& index);
  Status find_messages(const ChunkIndex& index, const RawRecord& record, Run& run) const;
  void release_current();
  void push(std::unique_ptr<Run> run) {
    heap.push_back(std::move(run));
    std::push_heap(heap.begin(), heap.end(), comes_later);
  }
  Result<std::optional<MessageView>> next();
};

void MessageCursor::Impl::start() {
  wanted.assign(65536, false);
  for (const auto& [id, channel] : state->channels) {
    wanted[id] = filter.topics.empty() || std::find(filter.topics.begin(), filter.topics.end(),
                                                    channel.topic) != filter.topics.end();
  }
  for (const ChunkIndex& chunk : state->chunks) {
    if (is_wanted(chunk)) pending.push_back(&chunk);
  }
  std::stable_sort(pending.begin(), pending.end(), [](const ChunkIndex* a, const ChunkIndex* b) {
    return std::make_pair(a->message_start_time, a->chunk_start_offset) >
           std::make_pair(b->message_start_time, b->chunk_start_offset);
  });
  add_loose_messages();
}

void MessageCursor::Impl::add_loose_messages() {
  auto run = std::make_unique<Run>();
  run->in_file = true;
  for (const LooseMessage& message : state->loose_messages) {
    if (in_time(message.log_time)) run->entries.push_back({message.log_time, message.record});
  }
  sort_by_time(run->entries);
  if (!run->entries.empty()) push(std::move(run));
}

Status MessageCursor::Impl::load(const ChunkIndex& index) {
  const ByteSource& source = *state->source;
  const std::uint64_t offset = index.chunk_start_offset;
  if (index.uncompressed_size >
      state->params.max_memory - std::min(state->params.max_memory, memory)) {
    return error_at(source, offset,
                    "more than " + std::to_string(state->params.max_memory) +
                        " bytes of chunks overlap in time; read fewer topics or a shorter time");
  }
  RecordStream stream(source, offset, offset + index.chunk_length);
  const auto record = stream.next();
  if (!record.ok()) return record.error();
  if (!record->has_value() || (*record)->opcode != Opcode::kChunk) {
    return error_at(source, offset,
                    "the index names a chunk here, and there is none; its messages are lost");
  }
  auto run = spare ? std::move(spare) : std::make_unique<Run>();
  run->file_offset = offset;
  run->at = 0;
  run->entries.clear();
  Chunk chunk;
  Status done =
      read_chunk(source, **record, state->params.max_chunk_size, content, chunk, run->records);
  if (done.ok() && chunk.uncompressed_size != index.uncompressed_size) {
    done = error_at(source, offset, "the index gives another size of this chunk; it is left out");
  }
  if (done.ok()) done = find_messages(index, **record, *run);
  if (!done.ok() || run->entries.empty()) {
    spare = std::move(run);
    return done;
  }
  memory += run->records.size();
  push(std::move(run));
  return {};
}

Status MessageCursor::Impl::find_messages(const ChunkIndex& index, const RawRecord& record,
                                          Run& run) const {
  std::string disagreement;
  std::string problem = walk_chunk(
      run.records, [](const Schema&) {}, [](const Channel&) {},
      [&](const Message& message, const RawRecord& place) {
        if (state->channels.count(message.channel_id) == 0) {
          disagreement = "has a message of channel " + std::to_string(message.channel_id) +
                         ", which nothing describes";
        }
        if (message.log_time < index.message_start_time ||
            message.log_time > index.message_end_time) {
          disagreement = "has a message of " + std::to_string(message.log_time) +
                         " ns, outside of the time that the index gives";
        }
        if (wanted[message.channel_id] && in_time(message.log_time)) {
          run.entries.push_back({message.log_time, place});
        }
      });
  if (problem.empty()) problem = disagreement;
  if (!problem.empty()) {
    return error_at(*state->source, record.offset, "chunk " + problem + "; its messages are lost");
  }
  sort_by_time(run.entries);
  return {};
}

void MessageCursor::Impl::release_current() {
  if (!current) return;
  if (++current->at < current->entries.size()) {
    push(std::move(current));
    return;
  }
  memory -= current->in_file ? 0 : current->records.size();
  if (!current->in_file) spare = std::move(current);
  current.reset();
}

Result<std::optional<MessageView>> MessageCursor::Impl::next() {
  release_current();
  for (;;) {
    while (!pending.empty() &&
           (heap.empty() || pending.back()->message_start_time <= heap.front()->entry().log_time)) {
      const ChunkIndex& index = *pending.back();
      pending.pop_back();
      if (const Status done = load(index); !done.ok()) return done.error();
    }
    if (heap.empty()) return std::optional<MessageView>();
    std::pop_heap(heap.begin(), heap.end(), comes_later);
    current = std::move(heap.back());
    heap.pop_back();

    MessageView view;
    const RawRecord& record = current->entry().record;
    if (current->in_file) {
      RecordStream stream(*state->source, record.offset, record.end());
      const Status done = stream.decode_into(record, view.message, content);
      if (!done.ok()) return done.error();
      if (!wanted[view.message.channel_id]) {
        release_current();
        continue;
      }
    } else if (!decode(content_of(current->records, record), view.message)) {
      release_current();  // cannot happen: it was decoded when the chunk was loaded
      continue;
    }
    const auto channel = state->channels.find(view.message.channel_id);
    view.channel = &channel->second;
    const auto schema = state->schemas.find(channel->second.schema_id);
    if (schema != state->schemas.end()) view.schema = &schema->second;
    return std::optional<MessageView>(view);
  }
}

MessageCursor::MessageCursor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MessageCursor::MessageCursor(MessageCursor&&) noexcept = default;
MessageCursor& MessageCursor::operator=(MessageCursor&&) noexcept = default;
MessageCursor::~MessageCursor() = default;

Result<std::optional<MessageView>> MessageCursor::next() {
  return impl_->next();
}

MessageCursor Reader::messages(Filter filter) const {
  auto impl = std::make_unique<MessageCursor::Impl>();
  impl->state = state_;
  impl->filter = std::move(filter);
  impl->start();
  return MessageCursor(std::move(impl));
}

}  // namespace swiftlet::mcap
