// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <atomic>
#include <memory>

namespace swiftlet {

/// Nothing is sent while it is false.
using Gate = std::shared_ptr<std::atomic<bool>>;

/// A transport that sends only while its gate is open.
///
/// Fast DDS 2.9 announces a participant before it listens to answers
/// (RTPSParticipantImpl::enable). Peers that answer within that moment, as those on the same
/// machine do, are not heard, and do not answer again: they are found with their own next
/// announcement, a second and more later. Behind a gate that opens once the participant listens,
/// the first announcement that goes out is one that will be answered.
///
/// What it receives it hands on if it is sound (RtpsGuard); the rest is counted and logged.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> gated(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport, Gate gate);

}  // namespace swiftlet
