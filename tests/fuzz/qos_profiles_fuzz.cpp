// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A user's file of quality of service profiles, read by us and by the XML parser of Fast DDS.
#include "components/runtime/config/config.hpp"
#include "components/runtime/dds/qos_overrides.hpp"
#include "components/runtime/log.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace swiftlet;
  static const bool is_quiet = set_log_level("off");
  fuzz::demand(is_quiet, "the log can be turned off");
  const fuzz::FileInMemory file(".xml", data, size);
  try {
    (void)QosOverrides::load(file.path(), {{"imu0", "scan", "odometry"}, "uav1"});
  } catch (const ConfigError&) {
  }
  return 0;
}
