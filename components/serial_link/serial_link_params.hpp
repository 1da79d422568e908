// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/runtime/config/config.hpp"
#include "components/serial_link/link_outbox.hpp"

namespace swiftlet {

/// The end of the line that this is.
enum class LinkRole { kVehicle, kGround };

struct SerialLinkParams {
  LinkRole role = LinkRole::kVehicle;
  std::string device;
  int baud = 19'200;
  LinkOutbox::Params outbox;
};

/// Throws ConfigError.
SerialLinkParams read_serial_link(const Config& config);

}  // namespace swiftlet
