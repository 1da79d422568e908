// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/basics/whole_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace swiftlet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class WholeFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              (std::string("swiftlet-whole-") + info->name() + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string why_not(const fs::path& file) const {
    const Status status = check_writable(file);
    return status.ok() ? "" : status.error().reason;
  }
  fs::path folder_;
};

TEST_F(WholeFile, ReplacesTheOldOneAndLeavesNothingBeside) {
  const fs::path file = folder_ / "a";
  ASSERT_TRUE(write_whole(file, "old and longer").ok());
  ASSERT_TRUE(write_whole(file, "new").ok());
  std::ifstream stream(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(WholeFile, WhatCanBeWrittenIsKnownBefore) {
  EXPECT_EQ(why_not(folder_ / "a"), "");
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  EXPECT_EQ(why_not("a-file-here"), "");
  fs::current_path(before);
  EXPECT_FALSE(fs::exists(folder_ / "a")) << "it only looks";
  EXPECT_THAT(why_not(folder_), HasSubstr("is a folder"));
  EXPECT_THAT(why_not(folder_ / ""), HasSubstr("is a folder"));
  EXPECT_THAT(why_not(folder_ / "none" / "a"), HasSubstr("make it first"));
  ASSERT_TRUE(write_whole(folder_ / "file", "x").ok());
  EXPECT_THAT(why_not(folder_ / "file" / "a"), HasSubstr("there is no folder"));
}

TEST_F(WholeFile, AFolderThatMayNotBeWrittenToIsNamed) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(why_not(folder_ / "a"), HasSubstr("you may not write into"));
  fs::permissions(folder_, fs::perms::owner_all);
}

}  // namespace
}  // namespace swiftlet
