// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What the tests with real processes share.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/system/process.hpp"

namespace swiftlet::test {

inline constexpr Seconds kStartLimit{15.0};    ///< for a process to do its first work
inline constexpr Seconds kExitLimit{10.0};     ///< for a process to end when it is asked to
inline constexpr Seconds kFlightLimit{120.0};  ///< for a whole flight in lockstep

/// SWIFTLET_FULL_TESTS=1 asks for the long form of tests that have one.
bool full_tests();

/// A DDS domain that no other test has at this moment. Tests run beside each other.
class DomainLease {
 public:
  DomainLease();
  ~DomainLease();
  DomainLease(const DomainLease&) = delete;
  DomainLease& operator=(const DomainLease&) = delete;
  int domain() const { return domain_; }

 private:
  int domain_ = -1;
  int lock_ = -1;
};

/// A folder and a DDS domain of its own, and the program to run in them.
class SystemTest : public testing::Test {
 protected:
  SystemTest();
  ~SystemTest() override;

  using Arguments = std::vector<std::string>;
  /// Starts `swiftlet <arguments>`.
  Process start(const Arguments& arguments);
  /// Runs `swiftlet <arguments>` to its end; exit code -1 where it does not come within `limit`.
  Finished run(const Arguments& arguments, Seconds limit = kFlightLimit);

  /// Asks a process to end, and expects exit code `code`.
  void expect_end(Process& process, int signal, int code);

  /// Any other command, in the same folder and domain.
  Process start_command(const Arguments& command);

  int domain() const { return domain_.domain(); }
  const std::filesystem::path& folder() const { return folder_; }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes a file into the folder and returns its path.
  std::string write(const std::string& name, const std::string& content) const;

  Process::Environment environment_;

 private:
  DomainLease domain_;
  std::filesystem::path folder_;
  int started_ = 0;
};

std::string office();       ///< the scenario that everything is measured with
std::string closed_door();  ///< the same with a door closed
std::string house();        ///< eight rooms to explore
std::string hop_world();    ///< the SDFormat file of hop()
std::string hop();          ///< one room and one waypoint: the shortest flight that is whole

/// The report of a flight; null where there is none.
nlohmann::json read_report(const std::filesystem::path& folder);

}  // namespace swiftlet::test
