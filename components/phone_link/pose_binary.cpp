// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "components/phone_link/pose_fields.hpp"

namespace swiftlet {
namespace {

constexpr std::uint8_t kMagic[] = {'S', 'W', 'P', 'H'};
constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kHasCovariance = 0x01;
constexpr std::size_t kChecksum = 4;
constexpr std::size_t kShort = 80 + kChecksum;  // without a covariance [byte]
constexpr std::size_t kLong = kShort + 21 * sizeof(float);

/// Little endian, whatever the processor is.
class Writer {
 public:
  template <class Unsigned>
  void number(Unsigned value) {
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
  }
  void real(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    number(bits);
  }
  void real(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    number(bits);
  }
  void append(const std::uint8_t* bytes, std::size_t size) {
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  DatagramBytes& bytes() { return bytes_; }

 private:
  DatagramBytes bytes_;
};

/// The caller has checked that so much is there.
class Reader {
 public:
  explicit Reader(const std::uint8_t* bytes) : next_(bytes) {}
  template <class Unsigned>
  Unsigned number() {
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
      value = static_cast<Unsigned>(value | static_cast<Unsigned>(next_[i]) << (8 * i));
    }
    next_ += sizeof(Unsigned);
    return value;
  }
  double real() {
    const auto bits = number<std::uint64_t>();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  float single() {
    const auto bits = number<std::uint32_t>();
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

 private:
  const std::uint8_t* next_;
};

Eigen::Matrix<double, 6, 6> read_covariance(Reader& reader) {
  Eigen::Matrix<double, 6, 6> covariance;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      covariance(row, column) = covariance(column, row) = static_cast<double>(reader.single());
    }
  }
  return covariance;
}

}  // namespace

DatagramBytes encode_binary(const PhonePose& pose) {
  Writer writer;
  writer.append(kMagic, sizeof(kMagic));
  writer.number(kVersion);
  writer.number(static_cast<std::uint8_t>(pose.covariance ? kHasCovariance : 0));
  writer.number(static_cast<std::uint16_t>(pose.covariance ? kLong : kShort));
  writer.number(pose.session);
  writer.number(pose.sequence);
  writer.number(static_cast<std::uint64_t>(pose.time.count()));
  for (const double coordinate : pose.position) writer.real(coordinate);
  for (const double coefficient : pose.attitude.coeffs()) writer.real(coefficient);  // x, y, z, w
  if (pose.covariance) {
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        writer.real(static_cast<float>((*pose.covariance)(row, column)));
      }
    }
  }
  writer.number(crc32_of(writer.bytes().data(), writer.bytes().size()));
  return std::move(writer.bytes());
}

Result<PhonePose> decode_binary(const std::uint8_t* bytes, std::size_t size) {
  if (size < sizeof(kMagic) || !std::equal(std::begin(kMagic), std::end(kMagic), bytes)) {
    return Error{"it does not begin with SWPH"};
  }
  if (size != kShort && size != kLong) {
    return Error{fmt::format("it has {} bytes; a pose has {} or {}", size, kShort, kLong)};
  }
  Reader reader(bytes + sizeof(kMagic));
  const auto version = reader.number<std::uint8_t>();
  if (version != kVersion) {
    return Error{fmt::format("it is of version {}; {} is understood", version, kVersion)};
  }
  const std::size_t body = size - kChecksum;
  if (Reader(bytes + body).number<std::uint32_t>() != crc32_of(bytes, body)) {
    return Error{"its checksum does not fit"};
  }
  const auto flags = reader.number<std::uint8_t>();
  if ((flags & ~kHasCovariance) != 0) return Error{"it has flags that mean nothing"};
  const bool has_covariance = (flags & kHasCovariance) != 0;
  if (reader.number<std::uint16_t>() != size || has_covariance != (size == kLong)) {
    return Error{"its length is not what it says"};
  }
  PhonePose pose;
  pose.session = reader.number<std::uint32_t>();
  pose.sequence = reader.number<std::uint32_t>();
  pose.time = Duration(static_cast<std::int64_t>(reader.number<std::uint64_t>()));
  for (double& coordinate : pose.position) coordinate = reader.real();
  for (double& coefficient : pose.attitude.coeffs()) coefficient = reader.real();
  if (has_covariance) pose.covariance = read_covariance(reader);
  if (Status status = check_pose(pose); !status) return status.error();
  return pose;
}

}  // namespace swiftlet
