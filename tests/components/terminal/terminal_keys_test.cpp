// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/terminal/terminal.hpp"

namespace swiftlet {
namespace {

using ::testing::ElementsAre;

TEST(TerminalKeys, AreWhatATerminalSends) {
  std::string input = " s+-q\x1b[C\x1b[D\x1bOC";
  EXPECT_THAT(take_keys(input), ElementsAre(key(' '), key('s'), key('+'), key('-'), key('q'),
                                            Key::kRight, Key::kLeft, Key::kRight));
  EXPECT_EQ(input, "");
  // Other keys are nothing, whatever letters are in their sequences: up, page down, F5, Ctrl-right.
  input = "\x1b[A\x1b[6~\x1b[15~\x1b[1;5C\x01\x02";
  EXPECT_THAT(take_keys(input), ElementsAre(Key::kRight));
  // A sequence may come in pieces.
  input = "x\x1b[";
  EXPECT_THAT(take_keys(input), ElementsAre(key('x')));
  input += "D.";
  EXPECT_THAT(take_keys(input), ElementsAre(Key::kLeft, key('.')));
  input = "\x1bq";  // Escape, then q
  EXPECT_THAT(take_keys(input), ElementsAre(key('q')));
}

}  // namespace
}  // namespace swiftlet
