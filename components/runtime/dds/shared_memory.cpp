// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <vector>

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

const std::string kClaim = "swiftlet_claim_";
const std::string kSegment = "fast_datasharing_";  // Fast DDS 2.9

bool begins_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// Whether the path still leads to the open file: another process may have removed it meanwhile.
bool is_at(int descriptor, const fs::path& file) {
  struct stat open_file {};
  struct stat at_path {};
  return fstat(descriptor, &open_file) == 0 && stat(file.c_str(), &at_path) == 0 &&
         open_file.st_dev == at_path.st_dev && open_file.st_ino == at_path.st_ino;
}

std::vector<fs::path> files_of(const fs::path& folder, const std::string& prefix) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (begins_with(entry->path().filename().string(), prefix)) files.push_back(entry->path());
  }
  return files;
}

}  // namespace

SharedMemoryClaim::SharedMemoryClaim(const std::string& guid_prefix, const fs::path& folder)
    : file_(folder / (kClaim + guid_prefix)) {
  while (true) {
    descriptor_ = open(file_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
      throw std::system_error(errno, std::generic_category(), file_.string());
    }
    // Who cleans up may hold the lock for a moment, and then removes the file under us.
    if (flock(descriptor_, LOCK_EX) == 0 && is_at(descriptor_, file_)) return;
    close(descriptor_);
  }
}

SharedMemoryClaim::~SharedMemoryClaim() {
  unlink(file_.c_str());
  close(descriptor_);
}

int remove_orphaned_segments(const fs::path& folder) {
  int removed = 0;
  for (const fs::path& claim : files_of(folder, kClaim)) {
    const int descriptor = open(claim.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) continue;  // another user's, or gone
    const bool owner_is_dead =
        flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_at(descriptor, claim);
    if (owner_is_dead) {
      const std::string guid_prefix = claim.filename().string().substr(kClaim.size());
      for (const fs::path& segment : files_of(folder, kSegment + guid_prefix + "_")) {
        removed += unlink(segment.c_str()) == 0 ? 1 : 0;
      }
      removed += unlink(claim.c_str()) == 0 ? 1 : 0;  // last: until then it can be found again
    }
    close(descriptor);
  }
  return removed;
}

}  // namespace swiftlet
