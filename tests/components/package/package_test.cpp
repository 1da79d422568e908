// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Programs that others write: those that the READMEs show, built against the installed package.
#include "tests/components/package/consumer.hpp"

namespace swiftlet::test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const char* kWalk =
    "at 0.5 m\nat 1.0 m\nat 1.5 m\nat 2.0 m\nat 2.5 m\n"
    "at 3.0 m\nat 3.5 m\nat 4.0 m\nat 4.5 m\nat 5.0 m\n";

TEST_F(PackageTest, TheProgramOfTheRuntimesReadmeHearsWhatItSays) {
  extract("walk", "components/runtime/README.md", {"walk.cpp", "CMakeLists.txt"});
  ASSERT_NO_FATAL_FAILURE(build("walk"));

  const Finished live = run_built("walk", {"walk"});
  EXPECT_EQ(live.exit_code, 0) << live.err;
  // Live, the two may find each other after the first message.
  EXPECT_THAT(live.out, EndsWith("at 5.0 m\n"));
  EXPECT_THAT(kWalk, EndsWith(live.out)) << "a message is missing, or came twice";
  EXPECT_GT(live.duration.count(), 1.0) << "ten periods of 100 ms";

  const Finished lockstep = run_built("walk", {"walk", "lockstep"});
  EXPECT_EQ(lockstep.exit_code, 0) << lockstep.err;
  EXPECT_EQ(lockstep.out, kWalk);
}

TEST_F(PackageTest, TheProgramsOfTheBagsReadmeWriteARecordingAndReadIt) {
  extract("walks", "components/bag/README.md",
          {"write_walk.cpp", "read_walk.cpp", "CMakeLists.txt"});
  ASSERT_NO_FATAL_FAILURE(build("walks"));

  const std::string file = path("walk.mcap");
  const Finished written = run_built("walks", {"write_walk", file});
  EXPECT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(run({"bag", "verify", file}).exit_code, 0);
  const Finished read = run_built("walks", {"read_walk", file});
  EXPECT_EQ(read.exit_code, 0) << read.err;
  EXPECT_EQ(
      read.out,
      "0.0 s: at 0.5 m\n0.1 s: at 1.0 m\n0.2 s: at 1.5 m\n0.3 s: at 2.0 m\n0.4 s: at 2.5 m\n"
      "0.5 s: at 3.0 m\n0.6 s: at 3.5 m\n0.7 s: at 4.0 m\n0.8 s: at 4.5 m\n0.9 s: at 5.0 m\n");

  const Finished again = run_built("walks", {"write_walk", file});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr(file));
  const Finished nothing = run_built("walks", {"read_walk", path("nothing.mcap")});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("nothing.mcap"));
}

TEST_F(PackageTest, AllHeadersAndAllLibrariesAreComplete) {
  // A header that is installed includes only what is installed; and with every object of every
  // library in one program, nothing that they need is missing.
  write("whole/CMakeLists.txt", R"cmake(
    cmake_minimum_required(VERSION 3.25)
    project(whole LANGUAGES CXX)
    find_package(swiftlet REQUIRED)
    get_property(targets DIRECTORY PROPERTY IMPORTED_TARGETS)
    list(FILTER targets INCLUDE REGEX "^swiftlet::")
    set(folder ${CMAKE_PREFIX_PATH}/include/swiftlet)
    file(GLOB_RECURSE headers RELATIVE ${folder} ${folder}/*.hpp)
    list(TRANSFORM headers REPLACE "^idl/" "")
    list(TRANSFORM headers REPLACE "(.+)" "#include \"\\1\"\n")
    list(JOIN headers "" includes)
    file(WRITE ${CMAKE_BINARY_DIR}/whole.cpp "${includes}int main() { return swiftlet::qos::map.depth > 0 ? 0 : 1; }\n")
    add_executable(whole ${CMAKE_BINARY_DIR}/whole.cpp)
    target_link_libraries(whole PRIVATE ${targets})
    list(TRANSFORM targets REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE files)
    target_link_options(whole PRIVATE -Wl,--whole-archive ${files} -Wl,--no-whole-archive))cmake");
  ASSERT_NO_FATAL_FAILURE(build("whole"));
  EXPECT_EQ(run_built("whole", {"whole"}).exit_code, 0);
}

TEST_F(PackageTest, AnotherVersionIsRefused) {
  for (const std::string version : {"9.9", "0.0", "0.2"}) {
    write("v" + version + "/CMakeLists.txt",
          "cmake_minimum_required(VERSION 3.25)\n"
          "project(other LANGUAGES CXX)\n"
          "find_package(swiftlet " +
              version + " REQUIRED)\n");
    const Finished configured = configure("v" + version);
    EXPECT_NE(configured.exit_code, 0) << version;
    EXPECT_THAT(configured.err, AllOf(HasSubstr("requested version \"" + version + "\""),
                                      HasSubstr(std::string("version: ") + SWIFTLET_VERSION)));
  }
}

TEST_F(PackageTest, ALibraryThatIsNotThereIsNamed) {
  write("teleport/CMakeLists.txt", R"cmake(
    cmake_minimum_required(VERSION 3.25)
    project(teleport LANGUAGES CXX)
    find_package(swiftlet REQUIRED COMPONENTS runtime teleport))cmake");
  const Finished configured = configure("teleport");
  EXPECT_NE(configured.exit_code, 0);
  EXPECT_THAT(configured.err,
              AllOf(HasSubstr("swiftlet::teleport"), Not(HasSubstr("swiftlet::runtime"))));
}

TEST_F(PackageTest, TheProgramAloneLeavesOutTheLibraries) {
  const std::string robot = path("robot");
  const Finished installed = run_command({SWIFTLET_CMAKE, "--install", SWIFTLET_BINARY_DIR,
                                          "--component", "program", "--prefix", robot});
  ASSERT_EQ(installed.exit_code, 0) << installed.err;
  EXPECT_TRUE(std::filesystem::exists(robot + "/bin/swiftlet"));
  EXPECT_TRUE(std::filesystem::exists(robot + "/share/swiftlet/launch/office.yaml"));
  EXPECT_FALSE(std::filesystem::exists(robot + "/include"));
  std::vector<std::string> libraries;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(robot)) {
    if (entry.path().extension() == ".a") libraries.push_back(entry.path().string());
  }
  EXPECT_THAT(libraries, IsEmpty());
}

}  // namespace
}  // namespace swiftlet::test
