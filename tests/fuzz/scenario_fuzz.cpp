// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A scenario file.
#include "components/sim/scenario.hpp"

#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace swiftlet;
  try {
    Scenario::read(Config::parse(fuzz::text_of(data, size), "fuzz.yaml"));
  } catch (const ConfigError&) {
  }
  return 0;
}
