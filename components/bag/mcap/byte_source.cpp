// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace swiftlet::mcap {
namespace {

std::string range_error(std::uint64_t length, std::uint64_t size) {
  return std::to_string(length) + " bytes are expected here, and the file ends at byte " +
         std::to_string(size);
}

class FileSource final : public ByteSource {
 public:
  FileSource(int descriptor, std::uint64_t size, std::string name)
      : descriptor_(descriptor), size_(size), name_(std::move(name)) {}
  ~FileSource() override { ::close(descriptor_); }
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  const std::string& name() const override { return name_; }
  std::uint64_t size() const override { return size_; }

  Status read(std::uint64_t offset, std::uint64_t length, Bytes& out) const override {
    if (offset > size_ || length > size_ - offset) {
      return error_at(*this, offset, range_error(length, size_));
    }
    out.resize(static_cast<std::size_t>(length));
    std::size_t done = 0;
    while (done < out.size()) {
      const ssize_t count = ::pread(descriptor_, out.data() + done, out.size() - done,
                                    static_cast<off_t>(offset + done));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) {
        return error_at(*this, offset + done, std::string("cannot be read: ") + strerror(errno));
      }
      if (count == 0) return error_at(*this, offset + done, "the file was cut while it was read");
      done += static_cast<std::size_t>(count);
    }
    return {};
  }

 private:
  int descriptor_;
  std::uint64_t size_;
  std::string name_;
};

class MemorySource final : public ByteSource {
 public:
  MemorySource(Bytes bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }
  std::uint64_t size() const override { return bytes_.size(); }

  Status read(std::uint64_t offset, std::uint64_t length, Bytes& out) const override {
    if (offset > bytes_.size() || length > bytes_.size() - offset) {
      return error_at(*this, offset, range_error(length, bytes_.size()));
    }
    const auto start = bytes_.begin() + static_cast<std::ptrdiff_t>(offset);
    out.assign(start, start + static_cast<std::ptrdiff_t>(length));
    return {};
  }

 private:
  Bytes bytes_;
  std::string name_;
};

}  // namespace

Result<std::shared_ptr<const ByteSource>> open_file(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Error{path.string() + ": cannot be opened: " + strerror(errno)};
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    return Error{path.string() + ": is not a file; give the path of an .mcap file"};
  }
  return std::shared_ptr<const ByteSource>(std::make_shared<FileSource>(
      descriptor, static_cast<std::uint64_t>(status.st_size), path.string()));
}

std::shared_ptr<const ByteSource> from_memory(Bytes bytes, std::string name) {
  return std::make_shared<MemorySource>(std::move(bytes), std::move(name));
}

Error error_at(const ByteSource& source, std::uint64_t offset, const std::string& problem) {
  return Error{source.name() + ": byte " + std::to_string(offset) + ": " + problem};
}

}  // namespace swiftlet::mcap
