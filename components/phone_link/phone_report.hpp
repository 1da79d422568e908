// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "components/phone_link/phone_stream.hpp"
#include "diagnostic_msgs.h"

namespace swiftlet {

/// How well the phone is heard, for diagnostics.
class PhoneReport {
 public:
  std::uint64_t jumps = 0;
  JumpAbsorber::Jump last_jump;
  std::uint64_t clock_restarts = 0;
  std::uint64_t given_up = 0;  ///< datagrams that came faster than they were taken
  std::string obstacle;        ///< why there are no poses; "" where there are

  /// What became of the datagrams since the last report, and how things stand.
  diagnostic_msgs::msg::DiagnosticStatus next(const PhoneStream& stream);

 private:
  std::array<std::uint64_t, kPhoneVerdicts> reported_{};
  std::uint64_t jumps_reported_ = 0;
};

}  // namespace swiftlet
