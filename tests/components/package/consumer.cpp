// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/components/package/consumer.hpp"

#include <fstream>
#include <optional>

namespace swiftlet::test {
namespace {

constexpr Seconds kCommandLimit{60.0};

bool begins_with(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// Whether a line is "// NAME", "# NAME", or that with ": what it does".
bool names_file(const std::string& line, const std::string& name) {
  for (const std::string& comment : {"// " + name, "# " + name}) {
    if (line == comment || begins_with(line, comment + ":")) return true;
  }
  return false;
}

std::optional<std::string> code_block(const std::string& readme, const std::string& name) {
  std::ifstream stream(readme);
  std::string line;
  while (std::getline(stream, line)) {
    if (!begins_with(line, "```")) continue;
    std::string block;
    bool wanted = false;
    for (bool first = true; std::getline(stream, line) && line != "```"; first = false) {
      if (first) wanted = names_file(line, name);
      block += line + "\n";
    }
    if (wanted) return block;
  }
  return std::nullopt;
}

}  // namespace

PackageTest::PackageTest() {
  const Finished installed =
      run_command({SWIFTLET_CMAKE, "--install", SWIFTLET_BINARY_DIR, "--prefix", prefix()});
  if (installed.exit_code != 0) ADD_FAILURE() << installed.out << installed.err;
}

void PackageTest::extract(const std::string& project, const std::string& readme,
                          const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    const auto block = code_block(std::string(SWIFTLET_SOURCE_DIR) + "/" + readme, name);
    if (!block) ADD_FAILURE() << readme << " has no code block " << name;
    write(project + "/" + name, block.value_or(""));
  }
}

Finished PackageTest::configure(const std::string& project, const Arguments& options) {
  Arguments command{SWIFTLET_CMAKE,
                    "-G",
                    SWIFTLET_GENERATOR,
                    "-S",
                    path(project),
                    "-B",
                    path(project + "/build"),
                    "-DCMAKE_PREFIX_PATH=" + prefix(),
                    std::string("-DCMAKE_CXX_COMPILER=") + SWIFTLET_COMPILER,
                    std::string("-DCMAKE_CXX_FLAGS=") + SWIFTLET_COMPILER_FLAGS};
  command.insert(command.end(), options.begin(), options.end());
  return run_command(command);
}

void PackageTest::build(const std::string& project) {
  const Finished configured = configure(project);
  ASSERT_EQ(configured.exit_code, 0) << configured.out << configured.err;
  const Finished built = run_command({SWIFTLET_CMAKE, "--build", path(project + "/build")});
  ASSERT_EQ(built.exit_code, 0) << built.out << built.err;
}

Finished PackageTest::run_built(const std::string& project, const Arguments& command) {
  Arguments whole = command;
  whole.front() = path(project + "/build/" + command.front());
  return run_command(whole);
}

Finished PackageTest::run_command(const Arguments& command) {
  Process process = start_command(command);
  const auto finished = process.wait(kCommandLimit);
  if (finished) return *finished;
  ADD_FAILURE() << "did not end: " << testing::PrintToString(command);
  return {-1, process.out(), process.err(), kCommandLimit};
}

}  // namespace swiftlet::test
