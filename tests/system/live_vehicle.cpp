// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/live_vehicle.hpp"

#include <csignal>

namespace swiftlet::test {

void LiveVehicleTest::start_vehicle(const std::string& scenario) {
  hosts_ = {{"run", "sim", "--scenario", scenario},
            {"run", "estimator", "flight_controller"},
            {"run", "lidar_mapper", "planner"},
            {"run", "commander"}};
  for (const Arguments& host : hosts_) processes_.push_back(start(host));
}

void LiveVehicleTest::stop_vehicle() {
  for (Process& process : processes_) expect_end(process, SIGTERM, 0);
}

void LiveVehicleTest::kill_and_start_again(std::size_t index) {
  Process& process = processes_.at(index);
  ASSERT_TRUE(process.running()) << process.err();
  process.send(SIGKILL);
  const auto finished = process.wait(kExitLimit);
  ASSERT_TRUE(finished);
  ASSERT_EQ(finished->exit_code, 128 + SIGKILL);
  process = start(hosts_.at(index));
}

Finished LiveVehicleTest::gcs(const Arguments& arguments) {
  Arguments command{"gcs"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run(command, Seconds(10.0));
}

nlohmann::json LiveVehicleTest::status() {
  const Finished finished = gcs({"status", "--json"});
  if (finished.exit_code != 0) return nullptr;
  const auto json = nlohmann::json::parse(finished.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << finished.out;
  return json.is_discarded() ? nullptr : json;
}

void LiveVehicleTest::command(const Arguments& arguments) {
  const Finished finished = gcs(arguments);
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.out, arguments.front() + ": accepted\n");
}

void LiveVehicleTest::ends_in(const std::string& mode, const std::string& next, Seconds limit) {
  nlohmann::json last;
  ASSERT_TRUE(status_becomes("out of " + mode, limit, [&](const nlohmann::json& status) {
    last = status;
    return status["mode"] != mode;
  }));
  EXPECT_EQ(last["mode"], next) << last.dump(2);
}

double LiveVehicleTest::distance(const nlohmann::json& status, double x, double y) {
  const auto& position = status["position_m"];
  return std::hypot(position[0].get<double>() - x, position[1].get<double>() - y);
}

}  // namespace swiftlet::test
