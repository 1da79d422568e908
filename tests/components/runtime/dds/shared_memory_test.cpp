// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/shared_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <system_error>

namespace swiftlet {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class SharedMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "shared_memory_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void touch(const std::string& name) { std::ofstream(folder_ / name) << "x"; }
  std::set<std::string> files() {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.insert(entry.path().filename());
    }
    return names;
  }
  /// A process that claims the prefix, leaves two segments, and is killed.
  void die_with_claim(const std::string& prefix) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const SharedMemoryClaim claim(prefix, folder_);
      touch("fast_datasharing_" + prefix + "_0.0.1.3");
      touch("fast_datasharing_" + prefix + "_0.0.2.4");
      _exit(0);  // no destructors: as if killed
    }
    waitpid(child, nullptr, 0);
  }

  fs::path folder_;
};

TEST_F(SharedMemory, WhatADeadProcessLeftIsRemoved) {
  die_with_claim("01.0f");
  ASSERT_EQ(files().size(), 3u);
  EXPECT_EQ(remove_orphaned_segments(folder_), 3);
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(SharedMemory, WhatALivingProcessOrAStrangerOwnsStays) {
  const SharedMemoryClaim claim("01.0f", folder_);
  touch("fast_datasharing_01.0f_0.0.1.3");
  touch("fast_datasharing_99.99_0.0.1.3");  // nobody claims it: another program's
  touch("fastrtps_port7411");
  EXPECT_EQ(remove_orphaned_segments(folder_), 0);
  EXPECT_EQ(files().size(), 4u);
}

TEST_F(SharedMemory, AClaimEndsWithItsOwner) {
  { const SharedMemoryClaim claim("01.0f", folder_); }
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(SharedMemory, APrefixThatBeginsLikeADeadOneIsNotTakenForIt) {
  const SharedMemoryClaim claim("01.0f.1", folder_);
  touch("fast_datasharing_01.0f.1_0.0.1.3");
  die_with_claim("01.0f");
  EXPECT_EQ(remove_orphaned_segments(folder_), 3);
  EXPECT_THAT(files(), ElementsAre("fast_datasharing_01.0f.1_0.0.1.3", "swiftlet_claim_01.0f.1"));
}

TEST_F(SharedMemory, AFolderThatCannotBeUsedIsNamed) {
  EXPECT_EQ(remove_orphaned_segments(folder_ / "none"), 0);
  try {
    const SharedMemoryClaim claim("01.0f", folder_ / "none");
    FAIL() << "must throw";
  } catch (const std::system_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("none/swiftlet_claim_01.0f"));
  }
}

}  // namespace
}  // namespace swiftlet
