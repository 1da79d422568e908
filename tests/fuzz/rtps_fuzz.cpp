// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Datagrams at the guard in front of Fast DDS. What Fast DDS does with those that pass is tested
// with real processes (rtps_bytes_test.cpp).
#include "components/runtime/dds/rtps_guard.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  swiftlet::RtpsGuard guard;
  const bool first = guard.judge(data, size).problem == nullptr;
  // A datagram that comes twice says nothing new.
  const bool second = guard.judge(data, size).problem == nullptr;
  swiftlet::fuzz::demand(!first || second, "what passed once passes again");
  return 0;
}
