// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The stack in several processes in real time, and the ground station's view of it.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/system/system_test.hpp"

namespace swiftlet::test {

class LiveVehicleTest : public SystemTest {
 protected:
  /// One process for each of: simulator, estimation and control, mapping and planning, command.
  void start_vehicle(const std::string& scenario);
  /// All processes end with 0 when they are asked to.
  void stop_vehicle();
  /// Ends a process as a crash would, and starts the same at once.
  void kill_and_start_again(std::size_t index);

  /// Runs `gcs <arguments>`.
  Finished gcs(const Arguments& arguments);
  /// `gcs status --json`; null where no vehicle answers.
  nlohmann::json status();
  /// Asks for the status until `condition(status)` holds; reports the last one where it does not.
  template <class Condition>
  bool status_becomes(const std::string& what, Seconds limit, Condition condition);
  bool becomes_ready() {
    return status_becomes("ready", Seconds(30.0),
                          [](const nlohmann::json& s) { return s["ready"] == true; });
  }
  /// Sends a command that must be accepted.
  void command(const Arguments& arguments);
  /// Waits for the end of a mode, which must be `next`.
  void ends_in(const std::string& mode, const std::string& next, Seconds limit);
  /// Of the vehicle from a place, seen from above [m].
  static double distance(const nlohmann::json& status, double x, double y);

  std::vector<Arguments> hosts_;
  std::vector<Process> processes_;
};

template <class Condition>
bool LiveVehicleTest::status_becomes(const std::string& what, Seconds limit, Condition condition) {
  nlohmann::json last;
  const bool done = becomes_true(limit, [&] {
    last = status();
    return !last.is_null() && condition(last);
  });
  EXPECT_TRUE(done) << "never " << what << ": " << last.dump(2);
  return done;
}

}  // namespace swiftlet::test
