// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// A parameter file, read as components read theirs, and values of the command line.
#include "components/runtime/config/config.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace swiftlet;

void read_keys(const Config& config, int depth) {
  bool flag = false;
  int count = 0;
  double number = 1.0;
  std::string text;
  std::vector<double> numbers;
  std::vector<std::string> texts;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  config.read("flag", flag);
  config.read("count", count, {0, 100});
  config.read("number", number, kPositive);
  config.read("text", text);
  config.read("numbers", numbers);
  config.read("texts", texts);
  config.read("vector", vector);
  fuzz::demand(number > 0.0, "a number is in its range");
  (void)config.keys();
  (void)config.where("flag");
  if (depth == 0) return;
  read_keys(config.child("below"), depth - 1);
  for (const Config& item : config.list("items")) read_keys(item, 0);
}

/// What can be read can be printed, and read again as the same.
void check_dump(const Config& config) {
  try {
    const Config again = Config::parse(config.dump(), "dump.yaml");
    read_keys(again, 2);
    fuzz::demand(again.dump() == config.dump(), "a dump is read as what was dumped");
  } catch (const ConfigError& error) {
    fuzz::demand(false, "a dump can be read", error.what());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fuzz::text_of(data, size);
  try {
    const Config config = Config::parse(text, "fuzz.yaml");
    read_keys(config, 2);
    check_dump(config);
    config.finish();
  } catch (const ConfigError&) {
  }
  try {
    Config config;
    config.set("number", text);
    read_keys(config.with("text", text), 1);
    read_keys(config, 1);
    config.finish();
  } catch (const ConfigError&) {
  }
  return 0;
}
