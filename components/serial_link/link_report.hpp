// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "components/serial_link/link_frame.hpp"
#include "components/serial_link/link_outbox.hpp"
#include "components/serial_link/sequence_watch.hpp"
#include "diagnostic_msgs.h"

namespace swiftlet {

/// How well the line works, for diagnostics.
class LinkReport {
 public:
  std::string obstacle;            ///< why the device cannot be used; "" where it can
  std::uint64_t openings = 0;      ///< of the device
  std::optional<double> link_age;  ///< since the last sound frame [s]; nothing before the first
  bool silent = true;              ///< too long ago, or never
  double bytes_per_s = 0.0;        ///< that the line carries

  /// What happened since the last report, and how things stand. Called once a second.
  diagnostic_msgs::msg::DiagnosticStatus next(const FrameDecoder::Counts& received,
                                              const LinkOutbox::Counts& sent, std::uint64_t lost);

 private:
  FrameDecoder::Counts received_;  // as they were reported last
  LinkOutbox::Counts sent_;
  std::uint64_t lost_ = 0;
};

}  // namespace swiftlet
