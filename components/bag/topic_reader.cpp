// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/topic_reader.hpp"

#include <algorithm>
#include <utility>

namespace swiftlet {
namespace {

/// However large they are, so many samples have room.
constexpr int kLeastDepth = 8;

}  // namespace

TopicReader::TopicReader(Mailbox& mailbox, Participant& participant, const EndpointSpec& spec,
                         std::uint64_t max_bytes, OnSample on_sample)
    : SampleTask(mailbox),
      participant_(participant),
      spec_(spec),
      max_bytes_(max_bytes),
      on_sample_(std::move(on_sample)),
      reader_(make_reader()) {
  // No more samples wait than the first reader has room for.
  set_limit(spec.qos.depth);
}

std::unique_ptr<Reader> TopicReader::make_reader() {
  return participant_.make_reader(spec_, [this] { arrived(); });
}

bool TopicReader::take_one() {
  Cdr cdr;
  SampleOrigin origin;
  if (!take(cdr, origin)) return false;
  // For a while both readers hear the same.
  if (replaced_ && !watch_.is_new(origin.writer, origin.sequence)) return true;
  const std::uint64_t missing = watch_.missing_before(origin.writer, origin.sequence);
  if (max_bytes_ > 0) limit_memory(cdr.size(), origin.writer);
  on_sample_(std::move(cdr), origin, missing);
  return true;
}

bool TopicReader::take(Cdr& cdr, SampleOrigin& origin) {
  if (old_ && old_->take(cdr, &origin)) return true;
  if (!reader_->take(cdr, &origin)) return false;
  old_.reset();
  return true;
}

void TopicReader::limit_memory(std::size_t sample, const EndpointGuid& writer) {
  const auto depth = static_cast<std::uint64_t>(spec_.qos.depth);
  if (old_ || sample * depth <= 2 * max_bytes_) return;
  const int wanted = std::max(static_cast<int>(max_bytes_ / sample), kLeastDepth);
  if (wanted >= spec_.qos.depth) return;
  const bool is_of_this_process = endpoint_id(writer).rfind(participant_.id(), 0) == 0;
  if (is_of_this_process) return;
  spec_.qos.depth = wanted;
  old_ = std::move(reader_);
  reader_ = make_reader();
  replaced_ = true;
}

}  // namespace swiftlet
