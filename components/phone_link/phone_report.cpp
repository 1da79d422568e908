// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/phone_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "components/diagnostic_status.hpp"

namespace swiftlet {
namespace {

constexpr double kDegree = M_PI / 180.0;

}  // namespace

diagnostic_msgs::msg::DiagnosticStatus PhoneReport::next(const PhoneStream& stream) {
  using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name("phone_link");
  std::uint64_t dropped = 0;
  std::uint64_t accepted = 0;
  for (std::size_t i = 0; i < kPhoneVerdicts; ++i) {
    const auto verdict = static_cast<PhoneVerdict>(i);
    const std::uint64_t count = stream.count(verdict);
    const std::uint64_t fresh = count - std::exchange(reported_[i], count);
    (verdict == PhoneVerdict::kAccepted ? accepted : dropped) += fresh;
    add_value(status, to_string(verdict), std::to_string(count));
  }
  add_value(status, "given_up", std::to_string(given_up));
  add_value(status, "clock_restarts", std::to_string(clock_restarts));
  if (stream.phone()) {
    add_value(status, "phone", to_string(*stream.phone()));
    add_value(status, "clock_offset_s", fmt::format("{:.6f}", to_seconds(stream.clock().offset())));
    add_value(status, "clock_drift_ppm", fmt::format("{:.1f}", 1e6 * stream.clock().skew()));
  }
  const bool jumped = std::exchange(jumps_reported_, jumps) != jumps;
  const double remaining = stream.jumps().remaining().norm();
  add_value(status, "jumps", std::to_string(jumps));
  if (jumps > 0) {
    add_value(status, "last_jump_m", fmt::format("{:.3f}", last_jump.translation.norm()));
    add_value(status, "last_jump_deg", fmt::format("{:.1f}", last_jump.yaw / kDegree));
    add_value(status, "to_follow_m", fmt::format("{:.3f}", remaining));
    add_value(status, "to_follow_deg",
              fmt::format("{:.1f}", stream.jumps().remaining_yaw() / kDegree));
  }

  const bool follows = remaining > 0.0 || stream.jumps().remaining_yaw() != 0.0;
  if (!obstacle.empty()) {
    status.level(ERROR);
    status.message(obstacle);
  } else if (jumped || follows) {
    status.level(WARN);
    status.message(fmt::format("the phone jumped by {:.2f} m; {:.2f} m to follow",
                               last_jump.translation.norm(), remaining));
  } else {
    status.level(dropped > 0 ? WARN : OK);
    status.message(
        fmt::format("{} poses in the last second, {} datagrams dropped", accepted, dropped));
  }
  return status;
}

}  // namespace swiftlet
