// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "gcs/sticks/key_sticks.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

TEST(KeySticks, StayWhileTheKeyRepeatsAndGoBackSoonAfter) {
  KeySticks keys;
  const Time begin(10s);
  EXPECT_EQ(keys.at(begin).deflection(), 0.0);
  keys.press(key('w'), begin);
  keys.press(key('l'), begin + 500ms);
  EXPECT_EQ(keys.at(begin + 550ms).forward, 1.0);
  EXPECT_EQ(keys.at(begin + 550ms).turn, -1.0);
  EXPECT_EQ(keys.at(begin + KeySticks::kHold).forward, 0.0) << "it was not pressed again";
  EXPECT_EQ(keys.at(begin + KeySticks::kHold).turn, -1.0);
  for (Time now = begin; now < begin + 5s; now += 30ms) {
    keys.press(key('a'), now);
    EXPECT_EQ(keys.at(now + 20ms).left, 1.0);
  }
}

TEST(KeySticks, AnotherKeyLetsAllOfThemGo) {
  KeySticks keys;
  const Time begin(10s);
  for (const char pressed : {'w', 'd', 'i', 'j'}) keys.press(key(pressed), begin);
  const Sticks all = keys.at(begin);
  EXPECT_EQ(all.forward, 1.0);
  EXPECT_EQ(all.left, -1.0);
  EXPECT_EQ(all.up, 1.0);
  EXPECT_EQ(all.turn, 1.0);
  keys.press(key(' '), begin);
  EXPECT_EQ(keys.at(begin).deflection(), 0.0);
}

TEST(KeySticks, TheSwitchStaysWhereItIs) {
  KeySticks keys(true);
  const Time begin(10s);
  EXPECT_TRUE(keys.at(begin).assisted);
  keys.press(key('m'), begin);
  keys.press(key(' '), begin + 1s);
  EXPECT_FALSE(keys.at(begin + 60s).assisted);
}

}  // namespace
}  // namespace swiftlet
