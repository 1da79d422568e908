// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/bag/loss_ledger.hpp"
#include "components/bag/mcap/reader.hpp"

namespace swiftlet {

class RecordingCursor;

/// One file, or several that are read as one: the parts of a recording that was split, or
/// recordings of the same time. Topics of the same name and type are one. Parts begin with samples
/// of the parts before, so that each can be read alone; here those come once.
class Recording {
 public:
  /// Files, or folders with files (*.mcap), in whichever order. What cannot be read is an error
  /// where it stands alone, else it is in damage().
  static Result<Recording> open(const std::vector<std::filesystem::path>& paths);
  Recording(mcap::Reader file);  // NOLINT(google-explicit-constructor)

  /// What was opened, for people.
  const std::string& name() const;
  /// In the order of time.
  const std::vector<mcap::Reader>& files() const;

  const std::map<std::uint16_t, mcap::Schema>& schemas() const;
  const std::map<std::uint16_t, mcap::Channel>& channels() const;
  const mcap::Statistics& statistics() const;
  const std::vector<Error>& damage() const;
  /// Whether all files were closed.
  bool finished() const;

  /// By log time; those of the same time in the order of the files. As Reader::messages.
  RecordingCursor messages(const mcap::Filter& filter = {}) const;

  struct State;

 private:
  explicit Recording(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// One pass over the messages of a recording; as MessageCursor.
class RecordingCursor {
 public:
  RecordingCursor(RecordingCursor&&) noexcept;
  RecordingCursor& operator=(RecordingCursor&&) noexcept;
  ~RecordingCursor();

  Result<std::optional<mcap::MessageView>> next();

 private:
  friend class Recording;
  struct Impl;
  explicit RecordingCursor(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

/// The files that paths stand for: files themselves, or the *.mcap of folders, as people count.
Result<std::vector<std::filesystem::path>> recording_files(
    const std::vector<std::filesystem::path>& paths);

/// What the ledgers of all files count together; nothing where no file has one.
std::optional<LossLedger> losses_of(const Recording& recording);

/// The last metadata record with that name, of the first file that has one.
std::optional<mcap::Metadata> metadata_named(const Recording& recording, const std::string& name);

/// What is wrong with the files as the parts of one recording: parts that are not there.
std::vector<std::string> missing_parts(const Recording& recording);

}  // namespace swiftlet
