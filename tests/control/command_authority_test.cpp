// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "control/command_authority.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr Duration kLease = 30s;
constexpr Time kBegin(100s);

struct CommandAuthorityTest : ::testing::Test {
  CommandAuthority authority{kLease};
};

TEST_F(CommandAuthorityTest, TheFirstThatCommandsHasControlAndOthersHaveNot) {
  EXPECT_EQ(authority.holder(kBegin), "");
  EXPECT_TRUE(authority.claim("base", kBegin).ok());
  EXPECT_EQ(authority.holder(kBegin), "base");
  EXPECT_TRUE(authority.claim("base", kBegin + 1s).ok());
  const Status refused = authority.claim("tablet", kBegin + 1s);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().reason, HasSubstr("'base' has control"));
  EXPECT_THAT(refused.error().reason, HasSubstr("control give tablet"));
  EXPECT_EQ(authority.holder(kBegin + 1s), "base");
}

TEST_F(CommandAuthorityTest, OnlyTheHolderHandsOver) {
  ASSERT_TRUE(authority.claim("base", kBegin).ok());
  EXPECT_FALSE(authority.give("tablet", "tablet", kBegin).ok());
  EXPECT_FALSE(authority.release("tablet", kBegin).ok());
  EXPECT_FALSE(authority.give("base", "", kBegin).ok());
  EXPECT_EQ(authority.holder(kBegin), "base");
  EXPECT_TRUE(authority.give("base", "tablet", kBegin).ok());
  EXPECT_FALSE(authority.claim("base", kBegin).ok());
  EXPECT_TRUE(authority.claim("tablet", kBegin).ok());
  EXPECT_TRUE(authority.release("tablet", kBegin).ok());
  EXPECT_TRUE(authority.claim("base", kBegin).ok()) << "whoever comes next";
}

TEST_F(CommandAuthorityTest, WhoIsNotHeardForTheLeaseHasControlNoMore) {
  ASSERT_TRUE(authority.claim("base", kBegin).ok());
  authority.hear("base", kBegin + 20s);
  authority.hear("tablet", kBegin + 40s);
  EXPECT_FALSE(authority.claim("tablet", kBegin + 50s).ok()) << "30 s after it was heard, not more";
  authority.hear("base", kBegin + 51s);
  EXPECT_TRUE(authority.claim("tablet", kBegin + 52s).ok()) << "what was lost is not heard back";
  EXPECT_EQ(authority.holder(kBegin + 52s), "tablet");
}

TEST_F(CommandAuthorityTest, WhoIsGivenControlHasTheLeaseToUseIt) {
  ASSERT_TRUE(authority.claim("base", kBegin).ok());
  ASSERT_TRUE(authority.give("base", "tablet", kBegin + 25s).ok());
  EXPECT_EQ(authority.holder(kBegin + 55s), "tablet");
  EXPECT_EQ(authority.holder(kBegin + 56s), "");
}

TEST_F(CommandAuthorityTest, WhoGaveControlToNobodyMayHaveItBack) {
  ASSERT_TRUE(authority.claim("base", kBegin).ok());
  ASSERT_TRUE(authority.give("base", "tabelt", kBegin).ok());
  EXPECT_FALSE(authority.claim("base", kBegin + 1s).ok()) << "it has to say that it wants it";
  EXPECT_FALSE(authority.take("tablet", kBegin + 1s).ok()) << "nobody else may";
  EXPECT_TRUE(authority.take("base", kBegin + 1s).ok());
  EXPECT_EQ(authority.holder(kBegin + 1s), "base");
}

TEST_F(CommandAuthorityTest, WhoWasHeardSinceKeepsWhatItWasGiven) {
  for (const bool commands : {false, true}) {
    CommandAuthority handed{kLease};
    ASSERT_TRUE(handed.claim("base", kBegin).ok());
    ASSERT_TRUE(handed.give("base", "tablet", kBegin).ok());
    if (commands) {
      ASSERT_TRUE(handed.claim("tablet", kBegin + 1s).ok());
    } else {
      handed.hear("tablet", kBegin + 1s);
    }
    EXPECT_FALSE(handed.take("base", kBegin + 2s).ok());
    EXPECT_EQ(handed.holder(kBegin + 2s), "tablet");
  }
}

TEST_F(CommandAuthorityTest, AStandbyKnowsIt) {
  ASSERT_TRUE(authority.claim("base", kBegin).ok());
  CommandAuthority standby{kLease};
  standby.restore(authority.state());
  EXPECT_FALSE(standby.claim("tablet", kBegin + 1s).ok());
  EXPECT_TRUE(standby.claim("tablet", kBegin + 31s).ok());

  ASSERT_TRUE(authority.give("base", "tabelt", kBegin).ok());
  standby.restore(authority.state());
  EXPECT_TRUE(standby.take("base", kBegin + 1s).ok());
}

}  // namespace
}  // namespace swiftlet
