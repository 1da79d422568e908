// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/system_test.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace swiftlet::test {
namespace {

// Below 102, where Linux begins to hand out ports to others; 77 and 78 are those of other tests.
constexpr int kFirstDomain = 79;
constexpr int kLastDomain = 101;

std::string source_file(const std::string& name) {
  return std::string(SWIFTLET_SOURCE_DIR) + "/" + name;
}

}  // namespace

bool full_tests() {
  const char* full = std::getenv("SWIFTLET_FULL_TESTS");
  return full != nullptr && std::string(full) == "1";
}

DomainLease::DomainLease() {
  const std::string stem = (std::filesystem::temp_directory_path() / "swiftlet-domain-").string();
  const bool found = becomes_true(Seconds(60.0), [&] {
    for (int domain = kFirstDomain; domain <= kLastDomain; ++domain) {
      const std::string file = stem + std::to_string(domain);
      const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) {
        lock_ = lock;
        domain_ = domain;
        return true;
      }
      if (lock >= 0) close(lock);
    }
    return false;
  });
  if (!found) throw std::runtime_error("all DDS domains of the tests are taken");
}

DomainLease::~DomainLease() {
  if (lock_ >= 0) close(lock_);  // which gives the lock back
}

SystemTest::SystemTest() {
  std::string name = (std::filesystem::temp_directory_path() / "swiftlet-system-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  folder_ = name;
  environment_["ROS_DOMAIN_ID"] = std::to_string(domain());
}

SystemTest::~SystemTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

Process SystemTest::start(const Arguments& arguments) {
  Arguments command{SWIFTLET_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return start_command(command);
}

Process SystemTest::start_command(const Arguments& command) {
  std::filesystem::create_directories(folder_ / "log");
  return Process(command, environment_, folder_ / "log" / std::to_string(++started_));
}

Finished SystemTest::run(const Arguments& arguments, Seconds limit) {
  Process process = start(arguments);
  const auto finished = process.wait(limit);
  if (finished) return *finished;
  ADD_FAILURE() << "did not end: swiftlet " << testing::PrintToString(arguments);
  return {-1, process.out(), process.err(), limit};
}

void SystemTest::expect_end(Process& process, int signal, int code) {
  ASSERT_TRUE(process.running()) << process.err();
  process.send(signal);
  const auto finished = process.wait(kExitLimit);
  ASSERT_TRUE(finished) << "does not end on signal " << signal << ": " << process.err();
  EXPECT_EQ(finished->exit_code, code) << finished->err;
}

std::string SystemTest::write(const std::string& name, const std::string& content) const {
  const std::filesystem::path file = folder_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
  return file.string();
}

std::string office() {
  return source_file("components/sim/scenarios/office.yaml");
}
std::string house() {
  return source_file("components/sim/scenarios/house.yaml");
}
std::string closed_door() {
  return source_file("components/sim/scenarios/office-closed-door.yaml");
}
std::string hop() {
  return source_file("tests/system/data/hop.yaml");
}
std::string hop_world() {
  return source_file("tests/system/data/room.sdf");
}

nlohmann::json read_report(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "report.json");
  if (!stream) return nullptr;
  return nlohmann::json::parse(stream, nullptr, false);
}

}  // namespace swiftlet::test
