// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// A serial device (termios): raw, 8 data bits, no parity, one stop bit, no flow control. Nobody
/// else may open it meanwhile. It waits for nothing, and is closed with this object.
class SerialPort {
 public:
  /// What `open` knows of, in ascending order.
  static const std::vector<int>& baud_rates();

  static Result<SerialPort> open(const std::string& device, int baud);

  SerialPort(SerialPort&& other) noexcept;
  SerialPort& operator=(SerialPort&& other) noexcept;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  ~SerialPort();

  /// Bytes that have come, up to `room`; an error where the device is gone.
  Result<std::size_t> read(std::uint8_t* bytes, std::size_t room);
  /// How many of them the device took; an error where it is gone.
  Result<std::size_t> write(const std::uint8_t* bytes, std::size_t size);
  /// Bytes that the device took and has not sent yet.
  std::size_t queued() const;

 private:
  SerialPort(const std::string& device, int descriptor)
      : device_(device), descriptor_(descriptor) {}

  std::string device_;
  int descriptor_ = -1;
};

}  // namespace swiftlet
