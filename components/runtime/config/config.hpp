// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/runtime/config/nearest_word.hpp"

namespace YAML {
class Node;
}

namespace swiftlet {

/// A configuration file that cannot be used. `what()` names file, line, what is wrong and what to
/// do about it; the program prints it and ends with exit code 2.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Limits of a number in a file, ends included. NaN and infinity are always refused.
struct Range {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
};
inline constexpr Range kPositive{1e-12, std::numeric_limits<double>::max()};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::max()};

/// One value that was asked for, as it is now: given in the file or the default.
struct ConfigEntry {
  std::string path;    ///< below the mapping that was asked: "model.mass"
  std::string type;    ///< "bool", "int", "double", "string", "double[]", "string[]"
  std::string value;   ///< as in YAML
  std::string limits;  ///< "from 0.05 to 1.39"; "" where there are none
};

/// One mapping of a YAML file, read key by key:
///
///     Config file = Config::load("estimator.yaml");
///     file.read("gyro_noise", params.gyro_noise, kPositive);
///     file.finish();
///
/// Every key that is asked for becomes a known key; `finish()` refuses all others and names the
/// nearest known one. All functions throw ConfigError.
class Config {
 public:
  /// An empty mapping: every optional value keeps its default.
  Config();
  static Config load(const std::filesystem::path& file);
  /// `name` stands for the file in error messages.
  static Config parse(const std::string& yaml, const std::string& name);

  /// Sets one value by hand, as the command line does; it wins over the file. `path` names the
  /// mappings above the key too: "estimator.gyro_noise".
  void set(const std::string& path, const std::string& value);

  /// A copy in which one value is set, and of which nothing was asked yet.
  Config with(const std::string& key, const std::string& value) const;

  bool has(const std::string& key) const;
  bool empty() const;
  /// Keys in the order of the file.
  std::vector<std::string> keys() const;

  /// Reads the value of `key` where it is given, and keeps `value` where it is not.
  void read(const std::string& key, bool& value) const;
  void read(const std::string& key, int& value, Range range = {}) const;
  void read(const std::string& key, double& value, Range range = {}) const;
  void read(const std::string& key, std::string& value) const;
  void read(const std::string& key, std::vector<double>& value, Range range = {}) const;
  void read(const std::string& key, std::vector<std::string>& value) const;
  void read(const std::string& key, Eigen::Vector2d& value, Range range = {}) const;
  void read(const std::string& key, Eigen::Vector3d& value, Range range = {}) const;

  /// The same for a value that the file must have.
  template <class T, class... R>
  void require(const std::string& key, T& value, R... range) const {
    demand(key);
    read(key, value, range...);
  }

  /// The mapping below `key`; an empty one where it is absent.
  Config child(const std::string& key) const;
  /// The sequence of mappings below `key`; empty where it is absent.
  std::vector<Config> list(const std::string& key) const;
  /// The sequence below `key` of mappings, or words: `- land` stands for `- land:`.
  std::vector<Config> steps(const std::string& key) const;
  /// The only key of this mapping. Refuses a mapping with more or none, and a key that is not
  /// among `known`.
  std::string only_key(const std::vector<std::string>& known) const;
  /// Refuses a value where `key` alone says it all.
  void require_nothing(const std::string& key) const;
  /// Refuses a file without `key`.
  void demand(const std::string& key) const;

  /// Every value that was read from this mapping and those below, in the order of asking.
  std::vector<ConfigEntry> entries() const;
  /// The same as a YAML file, which read again gives the same values.
  std::string dump() const;

  /// Refuses keys that nobody asked for, in the whole file that this mapping belongs to.
  void finish() const;

  /// Of `key` where it is given and of the mapping where it is not, from 1.
  int line(const std::string& key = {}) const;
  /// "file.yaml:12".
  std::string where(const std::string& key = {}) const;
  /// Throws ConfigError: "<where(key)>: <problem>".
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;
  /// The folder of the file, which paths in it are relative to.
  std::filesystem::path folder() const;

 private:
  struct File;
  Config(std::shared_ptr<File> file, std::string path, const YAML::Node& node);
  YAML::Node find(const std::string& key) const;
  void note(const std::string& key, const char* type, const std::string& value,
            const std::string& limits) const;

  std::shared_ptr<File> file_;
  std::string path_;  // of this mapping in the file: "" at the top, "sensors.imu0" below
  std::shared_ptr<YAML::Node> node_;
};

}  // namespace swiftlet
