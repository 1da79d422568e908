// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/bag/latched_samples.hpp"
#include "components/bag/loss_ledger.hpp"
#include "components/bag/mcap/writer.hpp"
#include "components/bag/recording_records.hpp"

namespace swiftlet {

struct RecordingWriterParams {
  std::filesystem::path file;
  bool overwrite = false;
  mcap::Compression compression = mcap::Compression::kZstd;
  std::uint64_t split_size = 0;  ///< a part that has grown to so many bytes is closed; 0: never
  Duration split_duration{0};    ///< a part that is so long is closed; 0: never
  mcap::Timestamp start = 0;     ///< of the run [ns]
  std::map<std::string, std::string> run{};  ///< of the record kRunRecord
};

/// One recording: one file, or parts flight_0.mcap, flight_1.mcap, ... Each part stands by itself:
/// it has all types and topics, begins with the latched samples of the parts before, and its ledger
/// counts what it lacks itself. Not thread-safe.
///
/// Samples that are repeated have the time of the part's beginning as log time, so that a part can
/// be played alone without a wait, and keep sequence and publish time.
class RecordingWriter {
 public:
  /// An error where the file, or one of its parts, exists and must not be overwritten.
  static Result<RecordingWriter> open(RecordingWriterParams params);

  /// Topics are numbered from 0 on.
  Status add_topic(RecordedTopic topic);
  Status write(const RecordedSample& sample);
  /// Latched samples from before this file, at its beginning.
  Status repeat(const std::vector<std::shared_ptr<const RecordedSample>>& samples,
                mcap::Timestamp at);
  /// Notes what was lost up to now, where that has changed.
  Status note(const LossLedger& losses, mcap::Timestamp now);
  /// Of what is written from now on.
  void set_compression(mcap::Compression compression);
  Status flush() { return writer_->flush(); }
  /// The ledger that was noted last becomes that of the file.
  Status close();

  std::uint64_t messages() const { return messages_; }
  std::uint64_t bytes() const { return closed_bytes_ + writer_->size(); }
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  explicit RecordingWriter(RecordingWriterParams params);
  bool is_split() const { return params_.split_size > 0 || params_.split_duration > Duration(0); }
  std::filesystem::path next_file() const;
  Status begin_part();
  Status write_definition(const RecordedTopic& topic);
  Status write_to_file(const RecordedSample& sample, mcap::Timestamp log_time);
  Status write_losses();
  bool part_is_full(mcap::Timestamp now) const;

  RecordingWriterParams params_;
  std::optional<mcap::Writer> writer_;
  std::vector<std::filesystem::path> files_;
  std::vector<RecordedTopic> topics_;
  std::vector<std::uint16_t> channels_;  // of the open file, by topic
  LatchedSamples latched_;
  LossLedger losses_;         // of the whole recording
  LossLedger losses_before_;  // those of the parts before
  mcap::Timestamp losses_time_ = 0;
  std::optional<LossLedger> written_;  // to the open file
  std::optional<mcap::Timestamp> part_begin_;
  std::uint64_t part_offset_ = 0;  // bytes of the part that are repetition
  std::uint64_t closed_bytes_ = 0;
  std::uint64_t messages_ = 0;
};

/// "flight_3.mcap" of "flight.mcap".
std::filesystem::path part_file(const std::filesystem::path& file, std::size_t part);

}  // namespace swiftlet
