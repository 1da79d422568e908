// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include "components/bag/recording_state.hpp"

namespace swiftlet {
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

}  // namespace swiftlet
