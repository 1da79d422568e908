// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/serial_port.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <termios.h>

#include <numeric>

#include "tests/components/serial_link/pty_pair.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Bytes all_bytes() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

TEST(SerialPort, CarriesEachByteAsItIsInBothDirections) {
  const PtyPair pty;
  auto port = SerialPort::open(pty.device(), 19'200);
  ASSERT_TRUE(port.ok()) << port.error().reason;
  const auto written = port->write(all_bytes().data(), 256);
  ASSERT_TRUE(written.ok());
  EXPECT_EQ(*written, 256u);
  EXPECT_EQ(pty.take(1000), all_bytes()) << "no new lines, no control characters";
  Bytes bytes(1000);
  const auto nothing = port->read(bytes.data(), bytes.size());
  ASSERT_TRUE(nothing.ok()) << "nothing to read is no failure";
  EXPECT_EQ(*nothing, 0u);
  EXPECT_EQ(pty.put(all_bytes()), 256u);
  const auto read = port->read(bytes.data(), bytes.size());
  ASSERT_TRUE(read.ok());
  bytes.resize(*read);
  EXPECT_EQ(bytes, all_bytes());
  EXPECT_TRUE(pty.take(1000).empty()) << "no echo";
}

TEST(SerialPort, SetsTheLineUp) {
  const PtyPair pty;
  const auto port = SerialPort::open(pty.device(), 19'200);
  ASSERT_TRUE(port.ok());
  const int other = open(pty.device().c_str(), O_RDWR | O_NOCTTY);  // as root, exclusive or not
  if (other < 0) GTEST_SKIP() << "the settings are seen by root only";
  termios settings{};
  ASSERT_EQ(tcgetattr(other, &settings), 0);
  close(other);
  EXPECT_EQ(cfgetispeed(&settings), static_cast<speed_t>(B19200));
  EXPECT_EQ(settings.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
  EXPECT_EQ(settings.c_cflag & (PARENB | CSTOPB | CRTSCTS), 0u);
  EXPECT_EQ(settings.c_lflag & (ICANON | ECHO | ISIG), 0u);
  EXPECT_EQ(settings.c_iflag & (IXON | ICRNL), 0u);
}

TEST(SerialPort, ADeviceThatVanishesIsToldByReadingAndWriting) {
  auto pty = std::make_unique<PtyPair>();
  auto port = SerialPort::open(pty->device(), 19'200);
  ASSERT_TRUE(port.ok());
  const std::string device = pty->device();
  pty.reset();
  std::uint8_t byte = 0;
  const auto read = port->read(&byte, 1);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().reason, device + " is gone");
  EXPECT_FALSE(port->write(&byte, 1).ok());
}

TEST(SerialPort, ADeviceThatTakesNothingMakesNobodyWait) {
  const PtyPair pty;
  auto port = SerialPort::open(pty.device(), 19'200);
  ASSERT_TRUE(port.ok());
  std::size_t taken = 0;
  for (int k = 0; k < 10'000; ++k) {
    const auto written = port->write(all_bytes().data(), 256);
    ASSERT_TRUE(written.ok());
    taken += *written;
  }
  EXPECT_LT(taken, 100'000u);
}

TEST(SerialPort, SaysWhyItCannotBeOpened) {
  const auto missing = SerialPort::open("/nowhere/ttyUSB0", 19'200);
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().reason, HasSubstr("/nowhere/ttyUSB0 cannot be opened: No such file"));
  const auto file = SerialPort::open("/dev/null", 19'200);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().reason, "/dev/null: is no serial device");
}

}  // namespace
}  // namespace swiftlet::test
