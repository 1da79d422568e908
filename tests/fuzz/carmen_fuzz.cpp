// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Lines of a CARMEN log, and the same bytes as a file, which may be compressed.
#include "components/bag/carmen/carmen_log.hpp"

#include <cmath>
#include <sstream>

#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace swiftlet;
  std::istringstream text(fuzz::text_of(data, size));
  const auto log = carmen::parse_log(text, "fuzz.log");
  if (log.ok()) {
    Time last{};
    for (const carmen::Scan& scan : log->scans) {
      fuzz::demand(scan.time >= last, "scans come by time");
      last = scan.time;
      fuzz::demand(std::isfinite(scan.angle_min) && std::isfinite(scan.laser_pose.theta),
                   "angles are finite");
      for (const float range : scan.ranges) fuzz::demand(range >= 0.0f, "ranges are not NaN");
    }
  }
  const fuzz::FileInMemory file(".log", data, size);
  (void)carmen::read_log(file.path());
  return 0;
}
