// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/link_report.hpp"

#include <fmt/format.h>

#include "components/diagnostic_status.hpp"

namespace swiftlet {

diagnostic_msgs::msg::DiagnosticStatus LinkReport::next(const FrameDecoder::Counts& received,
                                                        const LinkOutbox::Counts& sent,
                                                        std::uint64_t lost) {
  using namespace diagnostic_msgs::msg::DiagnosticStatus_Constants;
  const std::uint64_t bytes_sent = sent.bytes - sent_.bytes;
  const std::uint64_t newly_damaged = received.damaged - received_.damaged;
  const std::uint64_t newly_lost = lost - lost_;
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name("serial_link");
  if (!obstacle.empty()) {
    status.level(ERROR);
    status.message(obstacle);
  } else if (silent) {
    status.level(WARN);
    status.message("nothing is heard from the other end");
  } else if (newly_damaged + newly_lost > 0) {
    status.level(WARN);
    status.message(fmt::format("in the last second {} frames were damaged and {} lost",
                               newly_damaged, newly_lost));
  } else {
    status.message(fmt::format("{} of {:.0f} B/s sent", bytes_sent, bytes_per_s));
  }
  add_value(status, "frames_received", received.frames);
  add_value(status, "frames_damaged", received.damaged);
  add_value(status, "frames_lost", lost);
  add_value(status, "bytes_received_per_s", received.bytes - received_.bytes);
  add_value(status, "frames_sent", sent.frames);
  add_value(status, "bytes_sent_per_s", bytes_sent);
  add_value(status, "capacity_bytes_per_s", bytes_per_s);
  add_value(status, "telemetry_outdated", sent.outdated);
  add_value(status, "commands_given_up", sent.given_up);
  add_value(status, "device_openings", openings);
  if (link_age) add_value(status, "link_age_s", *link_age);
  received_ = received;
  sent_ = sent;
  lost_ = lost;
  return status;
}

}  // namespace swiftlet
