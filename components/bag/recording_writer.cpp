// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/recording_writer.hpp"

#include <algorithm>
#include <utility>

namespace swiftlet {
namespace {

/// Latched samples that are kept for the parts to come.
constexpr std::size_t kMaxLatchedBytes = 64 << 20;
/// Of log time: what a chunk holds is what a crash costs.
constexpr Duration kChunkDuration = std::chrono::milliseconds(500);

/// Parts of an earlier recording of that name.
std::vector<std::filesystem::path> parts_of(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> parts;
  std::error_code ignored;
  for (std::size_t part = 0;; ++part) {
    const auto candidate = part_file(file, part);
    if (!std::filesystem::exists(candidate, ignored)) return parts;
    parts.push_back(candidate);
  }
}

}  // namespace

std::filesystem::path part_file(const std::filesystem::path& file, std::size_t part) {
  const std::string name =
      file.stem().string() + "_" + std::to_string(part) + file.extension().string();
  return file.parent_path() / name;
}

RecordingWriter::RecordingWriter(RecordingWriterParams params)
    : params_(std::move(params)), latched_(kMaxLatchedBytes), losses_time_(params_.start) {}

Result<RecordingWriter> RecordingWriter::open(RecordingWriterParams params) {
  RecordingWriter writer(std::move(params));
  if (writer.is_split()) {
    // Parts of two recordings must not stand beside each other.
    for (const auto& part : parts_of(writer.params_.file)) {
      if (!writer.params_.overwrite) {
        return Error{part.string() + ": exists already; choose another name or remove it first"};
      }
      std::error_code error;
      if (!std::filesystem::remove(part, error) && error) {
        return Error{part.string() + ": cannot be removed: " + error.message()};
      }
    }
  }
  if (const Status begun = writer.begin_part(); !begun.ok()) return begun.error();
  return writer;
}

std::filesystem::path RecordingWriter::next_file() const {
  return is_split() ? part_file(params_.file, files_.size()) : params_.file;
}

Status RecordingWriter::begin_part() {
  const std::filesystem::path file = next_file();
  mcap::WriterParams params;
  params.profile = "ros2";
  params.overwrite = params_.overwrite;
  params.compression = params_.compression;
  params.chunk_duration = kChunkDuration;
  auto opened = mcap::Writer::open(file, params);
  if (!opened.ok()) return opened.error();
  writer_.emplace(std::move(opened).value());
  files_.push_back(file);
  channels_.clear();
  part_begin_.reset();
  part_offset_ = 0;
  losses_before_ = losses_;
  written_.reset();
  if (!params_.run.empty()) {
    const Status written = writer_->write(mcap::Metadata{kRunRecord, params_.run});
    if (!written.ok()) return written;
  }
  for (const RecordedTopic& topic : topics_) {
    if (const Status defined = write_definition(topic); !defined.ok()) return defined;
  }
  return write_losses();
}

Status RecordingWriter::add_topic(RecordedTopic topic) {
  topics_.push_back(std::move(topic));
  return write_definition(topics_.back());
}

Status RecordingWriter::write_definition(const RecordedTopic& topic) {
  const auto schema = writer_->add_schema(topic.type, topic.schema_encoding,
                                          mcap::ByteView(std::string_view(topic.schema)));
  if (!schema.ok()) return schema.error();
  const auto channel = writer_->add_channel(topic.name, "cdr", *schema, topic.metadata);
  if (!channel.ok()) return channel.error();
  channels_.push_back(*channel);
  return {};
}

bool RecordingWriter::part_is_full(mcap::Timestamp now) const {
  if (!part_begin_) return false;  // else a large map that is repeated would begin part after part
  const std::uint64_t own_bytes = writer_->size() - part_offset_;
  if (params_.split_size > 0 && own_bytes >= params_.split_size) return true;
  const auto longest = static_cast<mcap::Timestamp>(params_.split_duration.count());
  return longest > 0 && now >= *part_begin_ + longest;
}

Status RecordingWriter::write(const RecordedSample& sample) {
  if (part_is_full(sample.log_time)) {
    if (const Status closed = close(); !closed.ok()) return closed;
    closed_bytes_ += writer_->size();
    if (const Status begun = begin_part(); !begun.ok()) return begun;
  }
  if (!part_begin_) {
    if (is_split()) {
      const Status repeated = repeat(latched_.all(), sample.log_time);
      if (!repeated.ok()) return repeated;
    }
    part_begin_ = sample.log_time;
  }
  if (is_split() && topics_[sample.topic].latched) {
    latched_.note(std::make_shared<RecordedSample>(sample));
  }
  ++messages_;
  return write_to_file(sample, sample.log_time);
}

Status RecordingWriter::repeat(const std::vector<std::shared_ptr<const RecordedSample>>& samples,
                               mcap::Timestamp at) {
  mcap::Metadata part{kPartRecord, {}};
  if (is_split()) part.metadata["part"] = std::to_string(files_.size() - 1);
  for (const auto& sample : samples) {
    std::string& numbers = part.metadata[kRepeatedKey + topics_[sample->topic].name];
    numbers += (numbers.empty() ? "" : " ") + std::to_string(sample->sequence);
  }
  if (!part.metadata.empty()) {
    if (const Status written = writer_->write(part); !written.ok()) return written;
  }
  for (const auto& sample : samples) {
    if (const Status written = write_to_file(*sample, at); !written.ok()) return written;
  }
  if (samples.empty()) return {};
  const Status flushed = writer_->flush();
  part_offset_ = writer_->size();
  return flushed;
}

Status RecordingWriter::write_to_file(const RecordedSample& sample, mcap::Timestamp log_time) {
  return writer_->write(mcap::Message{channels_[sample.topic], sample.sequence, log_time,
                                      sample.publish_time, sample.data});
}

Status RecordingWriter::note(const LossLedger& losses, mcap::Timestamp now) {
  losses_ = losses;
  losses_time_ = now;
  return write_losses();
}

Status RecordingWriter::write_losses() {
  LossLedger own = since(losses_before_, losses_);
  if (written_ && *written_ == own) return {};
  const Status written = writer_->write(to_metadata(own, losses_time_));
  written_ = std::move(own);
  return written;
}

void RecordingWriter::set_compression(mcap::Compression compression) {
  params_.compression = compression;
  writer_->set_compression(compression);
}

Status RecordingWriter::close() {
  return writer_->close();
}

}  // namespace swiftlet
