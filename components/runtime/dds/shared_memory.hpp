// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet {

/// Where Fast DDS keeps the memory that writers and readers of plain frames share.
inline constexpr const char* kSharedMemory = "/dev/shm";

/// Says that this process lives and owns the segments of a participant. A segment's name begins
/// with the participant's GUID prefix, but nothing in it tells whether its process still lives, so
/// that Fast DDS leaves those of a killed process for ever. The claim is a file beside them, locked
/// for as long as the process lives: who gets the lock has proof that the owner is dead. (A process
/// id proves nothing: it may be used again, or belong to another container.)
class SharedMemoryClaim {
 public:
  /// `guid_prefix` as it is part of the segments' names. Throws std::system_error where `folder`
  /// cannot be written to.
  explicit SharedMemoryClaim(const std::string& guid_prefix,
                             const std::filesystem::path& folder = kSharedMemory);
  /// Removes the claim; the segments are Fast DDS's to remove.
  ~SharedMemoryClaim();
  SharedMemoryClaim(const SharedMemoryClaim&) = delete;
  SharedMemoryClaim& operator=(const SharedMemoryClaim&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Removes segments and claims of processes that are provably dead; returns how many files that
/// were. What other programs left is theirs, and is not touched.
int remove_orphaned_segments(const std::filesystem::path& folder = kSharedMemory);

}  // namespace swiftlet
