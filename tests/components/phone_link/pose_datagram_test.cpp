// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/pose_datagram.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <limits>

#include "tests/components/phone_link/phones.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;

void expect_equal(const PhonePose& a, const PhonePose& b) {
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.sequence, b.sequence);
  // JSON has seconds as a floating-point number.
  EXPECT_NEAR(to_seconds(a.time - b.time), 0.0, 2e-9);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.attitude.coeffs(), b.attitude.coeffs());
  ASSERT_EQ(a.covariance.has_value(), b.covariance.has_value());
  if (a.covariance) {
    EXPECT_EQ(*a.covariance, *b.covariance);
  }
}

void expect_refused(const DatagramBytes& bytes, const std::string& reason,
                    JsonPolicy json = JsonPolicy::kAny) {
  const auto pose = decode(bytes, json);
  ASSERT_FALSE(pose.ok()) << reason;
  EXPECT_THAT(pose.error().reason, HasSubstr(reason));
}
void expect_refused(const std::string& text, const std::string& reason,
                    JsonPolicy json = JsonPolicy::kAny) {
  expect_refused(bytes_of(text), reason, json);
}

/// With the checksum that belongs to the bytes before it.
DatagramBytes sealed(DatagramBytes bytes) {
  const std::size_t body = bytes.size() - 4;
  const auto sum = crc32(0, bytes.data(), static_cast<uInt>(body));
  for (std::size_t i = 0; i < 4; ++i) bytes[body + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  return bytes;
}

TEST(BinaryPose, ComesBackBitForBit) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const PhonePose sent = random_pose(random);
    const DatagramBytes bytes = encode_binary(sent);
    EXPECT_EQ(bytes.size(), sent.covariance ? 168U : 84U);
    const auto pose = decode(bytes, JsonPolicy::kRefused);
    ASSERT_TRUE(pose.ok()) << pose.error().reason;
    expect_equal(*pose, sent);
  }
}

/// The byte table of the README, written out: what a sender in another language produces.
TEST(BinaryPose, HasTheBytesOfTheTable) {
  PhonePose pose;
  pose.session = 0x04030201;
  pose.sequence = 0x08070605;
  pose.time = Duration(0x100f0e0d0c0b0a09);
  pose.position = {1.0, -2.0, 0.5};
  const DatagramBytes expected{'S',  'W',  'P',  'H',  // magic
                               1,    0,    84,   0,    // version, flags, length
                               0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08,  // session, sequence
                               0x09, 0x0a, 0x0b, 0x0c, 0x0d, 0x0e, 0x0f, 0x10,  // time
                               0,    0,    0,    0,    0,    0,    0xf0, 0x3f,  // x = 1
                               0,    0,    0,    0,    0,    0,    0x00, 0xc0,  // y = -2
                               0,    0,    0,    0,    0,    0,    0xe0, 0x3f,  // z = 0.5
                               0,    0,    0,    0,    0,    0,    0,    0,     // quaternion: x
                               0,    0,    0,    0,    0,    0,    0,    0,     // y
                               0,    0,    0,    0,    0,    0,    0,    0,     // z
                               0,    0,    0,    0,    0,    0,    0xf0, 0x3f,  // w = 1
                               0,    0,    0,    0};
  EXPECT_EQ(encode_binary(pose), sealed(expected));
}

TEST(BinaryPose, NoOneOrTwoFlippedBitsAreMissed) {
  std::mt19937 random(1);
  PhonePose pose = random_pose(random);
  pose.covariance.reset();
  DatagramBytes bytes = encode_binary(pose);
  const auto flip = [&](std::size_t bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << bit % 8));
  };
  const std::size_t bits = 8 * bytes.size();
  for (std::size_t first = 0; first < bits; ++first) {
    flip(first);
    ASSERT_FALSE(decode(bytes).ok()) << first;
    for (std::size_t second = 0; second < first; ++second) {
      flip(second);
      ASSERT_FALSE(decode(bytes).ok()) << first << " " << second;
      flip(second);
    }
    flip(first);
  }
}

TEST(BinaryPose, EveryOtherLengthIsRefused) {
  std::mt19937 random(1);
  DatagramBytes whole = encode_binary(random_pose(random));
  whole.resize(kLongestDatagram + 1);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    DatagramBytes bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    if (size >= 4) bytes = sealed(bytes);
    if (size != 84 && size != 168) {
      EXPECT_FALSE(decode(bytes).ok()) << size;
    }
  }
}

TEST(BinaryPose, WhatItSaysOfItselfMustFit) {
  const DatagramBytes sound = encode_binary(PhonePose{});
  ASSERT_TRUE(decode(sound).ok());
  const auto with = [&](std::size_t place, std::uint8_t value) {
    DatagramBytes bytes = sound;
    bytes[place] = value;
    return sealed(bytes);
  };
  expect_refused(with(0, 's'), "SWPH");
  expect_refused(with(4, 2), "version 2");
  expect_refused(with(5, 2), "flags");
  expect_refused(with(5, 1), "length");  // a covariance that is not there
  expect_refused(with(6, 85), "length");
  expect_refused(with(23, 0x80), "time");        // negative
  expect_refused(with(79, 0x40), "quaternion");  // w = 2 and more
  DatagramBytes nan = sound;
  nan[30] = 0xf8;
  nan[31] = 0x7f;
  expect_refused(sealed(nan), "position");
}

TEST(BinaryPose, ACovarianceMustBeOne) {
  PhonePose pose;
  pose.covariance = Eigen::Matrix<double, 6, 6>::Identity();
  ASSERT_TRUE(decode(encode_binary(pose)).ok());
  (*pose.covariance)(2, 2) = -1.0;
  expect_refused(encode_binary(pose), "covariance");
  (*pose.covariance)(2, 2) = std::numeric_limits<double>::quiet_NaN();
  expect_refused(encode_binary(pose), "covariance");
  pose.covariance->setOnes();
  expect_refused(encode_binary(pose), "covariance");
}

TEST(JsonPose, ComesBack) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const PhonePose sent = random_pose(random);
    const DatagramBytes bytes = encode_json(sent);
    const auto pose = decode(bytes, JsonPolicy::kChecked);
    ASSERT_TRUE(pose.ok()) << pose.error().reason << text_of(bytes);
    expect_equal(*pose, sent);
  }
}

const char* kPlain = R"({"sequence":1,"time":12.345,"position":[1,2,3],"orientation":[0,0,0,1]})";

TEST(JsonPose, IsWhatAScriptWrites) {
  const auto pose = decode(bytes_of(kPlain + std::string("\n")));
  ASSERT_TRUE(pose.ok()) << pose.error().reason;
  EXPECT_EQ(pose->session, 0U);
  EXPECT_EQ(pose->sequence, 1U);
  EXPECT_EQ(pose->time, Duration(12'345'000'000));
  EXPECT_EQ(pose->position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pose->attitude.w(), 1.0);
}

TEST(JsonPose, IsTakenAsFarAsThePolicyLetsIt) {
  expect_refused(kPlain, "'json'", JsonPolicy::kRefused);
  expect_refused(kPlain, "\"crc32\" is missing", JsonPolicy::kChecked);
  expect_refused(encode_json(PhonePose{}), "'json'", JsonPolicy::kRefused);
}

TEST(JsonPose, AChangedDigitIsSeen) {
  std::mt19937 random(1);
  const std::string sound = text_of(encode_json(random_pose(random)));
  for (std::size_t i = 0; i < sound.size(); ++i) {
    if (sound[i] < '0' || sound[i] > '9') continue;
    std::string text = sound;
    text[i] = static_cast<char>('0' + (text[i] - '0' + 1) % 10);
    EXPECT_FALSE(decode(bytes_of(text)).ok()) << text;
  }
}

TEST(JsonPose, IsStrict) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = kPlain;
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos);
    return text.replace(place, from.size(), to);
  };
  expect_refused("{", "no JSON");
  expect_refused("{} {}", "no JSON");
  expect_refused(changed("\"position\"", "\"positon\""), "did you mean \"position\"?");
  expect_refused(changed("\"time\":12.345,", ""), "\"time\" is missing");
  expect_refused(changed("\"time\"", "\"sequence\""), "twice");
  expect_refused(changed("12.345", "-1"), "time");
  expect_refused(changed("12.345", "1e300"), "time");
  expect_refused(changed("12.345", "1e999"), "no JSON");
  expect_refused(changed("12.345", "\"12\""), "\"time\" is no number");
  expect_refused(changed("\"sequence\":1", "\"sequence\":-1"), "sequence");
  expect_refused(changed("\"sequence\":1", "\"sequence\":1.5"), "sequence");
  expect_refused(changed("\"sequence\":1", "\"sequence\":4294967296"), "sequence");
  expect_refused(changed("[1,2,3]", "[1,2]"), "list of 3");
  expect_refused(changed("[1,2,3]", "[1,2,null]"), "list of 3");
  expect_refused(changed("[1,2,3]", "[1,2,1e7]"), "position");
  expect_refused(changed("[0,0,0,1]", "[0,0,0,2]"), "quaternion");
  expect_refused(changed("{\"seq", "{\"covariance\":[1],\"seq"), "list of 36");
  expect_refused(changed("{\"seq", "{\"crc32\":1,\"seq"), "last");
  expect_refused(changed("{\"seq", "{\"\\n\xc3\xa4\":1,\"seq"), "\"?\?\?\" means nothing");
  expect_refused("{" + std::string(3000, ' ') + "}", "longer");
  expect_refused("{\"time\":" + std::string(1500, '['), "no JSON");
}

}  // namespace
}  // namespace swiftlet::test
