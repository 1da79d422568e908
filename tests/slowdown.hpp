// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace swiftlet::test {

/// The sanitizers make a program many times slower. Deadlines are as many times longer, and where a
/// test takes thousands of random cases, as many times fewer are enough: what goes wrong in memory
/// or between threads, it does in any of them.
#if defined(__SANITIZE_THREAD__)
inline constexpr int kSlowdown = 20;
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr int kSlowdown = 8;
#else
inline constexpr int kSlowdown = 1;
#endif

}  // namespace swiftlet::test
