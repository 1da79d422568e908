// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What both forms of a datagram have in common.
#pragma once

#include "components/phone_link/pose_datagram.hpp"

namespace swiftlet {

/// Whether the numbers can be a pose: finite, in a believable range, a rotation, a covariance.
Status check_pose(const PhonePose& pose);

/// CRC-32 as zlib, Ethernet and java.util.zip.CRC32 compute it.
std::uint32_t crc32_of(const std::uint8_t* bytes, std::size_t size);

Result<PhonePose> decode_binary(const std::uint8_t* bytes, std::size_t size);
Result<PhonePose> decode_json(const std::uint8_t* bytes, std::size_t size, bool needs_checksum);

}  // namespace swiftlet
