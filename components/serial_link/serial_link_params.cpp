// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/serial_link/serial_link_params.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "components/serial_link/serial_port.hpp"

namespace swiftlet {
namespace {

/// A start bit, eight bits and a stop bit.
constexpr double kBitsPerByte = 10.0;

}  // namespace

SerialLinkParams read_serial_link(const Config& config) {
  SerialLinkParams params;
  std::string role;
  config.require("role", role);
  if (role != "vehicle" && role != "ground") {
    config.fail("role", fmt::format("'role' is vehicle or ground, not '{}'", role));
  }
  params.role = role == "vehicle" ? LinkRole::kVehicle : LinkRole::kGround;
  config.require("device", params.device);
  if (params.device.empty()) {
    config.fail("device", "'device' is the path of a serial device, such as /dev/ttyUSB0");
  }
  config.read("baud", params.baud);
  const std::vector<int>& rates = SerialPort::baud_rates();
  if (std::find(rates.begin(), rates.end(), params.baud) == rates.end()) {
    config.fail("baud",
                fmt::format("'baud' is one of {}, not {}", fmt::join(rates, ", "), params.baud));
  }
  params.outbox.bytes_per_s = params.baud / kBitsPerByte;
  config.read("bytes_per_s", params.outbox.bytes_per_s, {50.0, params.baud / kBitsPerByte});
  config.read("repeat", params.outbox.repeat, {0.05, 10.0});
  config.read("patience", params.outbox.patience, {0.1, 60.0});
  return params;
}

}  // namespace swiftlet
