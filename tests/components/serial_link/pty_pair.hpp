// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace swiftlet::test {

/// A pseudo-terminal in the place of a serial device: the device's path, and the other end of the
/// line.
class PtyPair {
 public:
  PtyPair() : line_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    char name[64];
    if (line_ < 0 || grantpt(line_) != 0 || unlockpt(line_) != 0 ||
        ptsname_r(line_, name, sizeof(name)) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    device_ = name;
  }
  ~PtyPair() { close(line_); }
  PtyPair(const PtyPair&) = delete;
  PtyPair& operator=(const PtyPair&) = delete;

  const std::string& device() const { return device_; }

  /// What has come, at most `room` bytes. Nothing while nobody has the device open.
  std::vector<std::uint8_t> take(std::size_t room) const {
    std::vector<std::uint8_t> bytes(room);
    const ssize_t size = ::read(line_, bytes.data(), room);
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }
  /// How many of them the line took.
  std::size_t put(const std::vector<std::uint8_t>& bytes) const {
    const ssize_t size = ::write(line_, bytes.data(), bytes.size());
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  }

 private:
  int line_;
  std::string device_;
};

}  // namespace swiftlet::test
