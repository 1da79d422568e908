// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/carmen/gzip_stream.hpp"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace swiftlet::carmen {

class GzipStream::Buffer : public std::streambuf {
 public:
  explicit Buffer(gzFile file) : file_(file) {}
  ~Buffer() override { gzclose(file_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

 protected:
  /// Throws where the file is damaged; the stream turns that into badbit.
  int_type underflow() override {
    const int count = gzread(file_, bytes_.data(), static_cast<unsigned>(bytes_.size()));
    int code = Z_OK;
    gzerror(file_, &code);
    if (count < 0 || (count == 0 && code != Z_OK && code != Z_STREAM_END)) {
      throw std::ios_base::failure("damaged");
    }
    if (count == 0) return traits_type::eof();
    setg(bytes_.data(), bytes_.data(), bytes_.data() + count);
    return traits_type::to_int_type(bytes_[0]);
  }

 private:
  gzFile file_;
  std::array<char, 1 << 16> bytes_{};
};

GzipStream::GzipStream(const std::filesystem::path& path) : std::istream(nullptr) {
  if (std::filesystem::is_directory(path)) {
    error_ = "is a folder; give a CARMEN log";
    return;
  }
  errno = 0;
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) {
    error_ = std::string("cannot be opened: ") + (errno != 0 ? strerror(errno) : "out of memory");
    return;
  }
  buffer_ = std::make_unique<Buffer>(file);
  rdbuf(buffer_.get());
}

GzipStream::~GzipStream() {
  rdbuf(nullptr);
}

}  // namespace swiftlet::carmen
