// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the tests of the simulator share.
#pragma once

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "components/runtime/config/config.hpp"
#include "components/sim/world.hpp"

namespace swiftlet::test {

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "swiftlet-sim-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << content;
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The message of the ConfigError that `action` throws, "" where it throws none.
template <class Action>
std::string config_error(Action action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

inline Shape ground_plane() {
  Shape plane;
  plane.model = "floor";
  plane.kind = Shape::Kind::kPlane;
  return plane;
}

inline World flat_world() {
  World world;
  world.add(ground_plane());
  return world;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

inline double variance(const std::vector<double>& values) {
  const double m = mean(values);
  double sum = 0.0;
  for (const double v : values) sum += (v - m) * (v - m);
  return sum / static_cast<double>(values.size());
}

/// Autocorrelation about a mean of zero at `lag` samples, as a fraction of that at lag zero.
inline double autocorrelation(const std::vector<double>& values, std::size_t lag) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i + lag < values.size(); ++i) product += values[i] * values[i + lag];
  for (const double v : values) square += v * v;
  return product / square;
}

}  // namespace swiftlet::test
