// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace swiftlet {
namespace {

constexpr struct {
  int baud;
  speed_t code;
} kSpeeds[] = {{1200, B1200},     {2400, B2400},     {4800, B4800},    {9600, B9600},
               {19200, B19200},   {38400, B38400},   {57600, B57600},  {115200, B115200},
               {230400, B230400}, {460800, B460800}, {921600, B921600}};

/// "" where it is done.
std::string set_up(int descriptor, int baud) {
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) {
    return errno == ENOTTY ? "is no serial device" : std::strerror(errno);
  }
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;  // modem lines do not matter
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  // With O_NONBLOCK: nothing to read is EAGAIN, so that 0 bytes are a device that is gone.
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  for (const auto& speed : kSpeeds) {
    if (speed.baud != baud) continue;
    cfsetispeed(&settings, speed.code);
    cfsetospeed(&settings, speed.code);
  }
  if (tcsetattr(descriptor, TCSANOW, &settings) != 0) return std::strerror(errno);
  if (ioctl(descriptor, TIOCEXCL) != 0) return std::strerror(errno);
  tcflush(descriptor, TCIOFLUSH);  // what came before is of no use
  return "";
}

}  // namespace

const std::vector<int>& SerialPort::baud_rates() {
  static const std::vector<int> rates = [] {
    std::vector<int> all;
    for (const auto& speed : kSpeeds) all.push_back(speed.baud);
    return all;
  }();
  return rates;
}

Result<SerialPort> SerialPort::open(const std::string& device, int baud) {
  const int descriptor = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    const int reason = errno;
    return Error{fmt::format("{} cannot be opened: {}", device,
                             reason == EBUSY    ? "another program has it"
                             : reason == EACCES ? "no permission; is the user in group dialout?"
                                                : std::strerror(reason))};
  }
  SerialPort port(device, descriptor);
  const std::string problem = set_up(descriptor, baud);
  if (!problem.empty()) return Error{fmt::format("{}: {}", device, problem)};
  return port;
}

SerialPort::SerialPort(SerialPort&& other) noexcept
    : device_(std::move(other.device_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

SerialPort& SerialPort::operator=(SerialPort&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

SerialPort::~SerialPort() {
  if (descriptor_ < 0) return;
  tcflush(descriptor_, TCOFLUSH);  // else closing waits for a line that takes nothing
  close(descriptor_);
}

Result<std::size_t> SerialPort::read(std::uint8_t* bytes, std::size_t room) {
  const ssize_t size = ::read(descriptor_, bytes, room);
  if (size > 0) return static_cast<std::size_t>(size);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
  return Error{fmt::format("{} is gone", device_)};
}

Result<std::size_t> SerialPort::write(const std::uint8_t* bytes, std::size_t size) {
  const ssize_t written = ::write(descriptor_, bytes, size);
  if (written >= 0) return static_cast<std::size_t>(written);
  if (errno == EAGAIN || errno == EINTR) return std::size_t{0};
  return Error{fmt::format("{} is gone", device_)};
}

std::size_t SerialPort::queued() const {
  int bytes = 0;
  return ioctl(descriptor_, TIOCOUTQ, &bytes) == 0 && bytes > 0 ? static_cast<std::size_t>(bytes)
                                                                : 0;
}

}  // namespace swiftlet
