// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/message.hpp"
#include "swiftlet_frames.h"

/// Types that writers and readers share in memory. Only types without strings and sequences can be
/// among them, and only such whose members lie in memory as in CDR; a test compares the two.
namespace swiftlet {

template <>
struct IsPlain<swiftlet_frames::msg::Image80k> : std::true_type {};
template <>
struct IsPlain<swiftlet_frames::msg::Image640k> : std::true_type {};
template <>
struct IsPlain<swiftlet_frames::msg::Image1M> : std::true_type {};
template <>
struct IsPlain<swiftlet_frames::msg::Cloud256k> : std::true_type {};
template <>
struct IsPlain<swiftlet_frames::msg::Cloud5M> : std::true_type {};

}  // namespace swiftlet
