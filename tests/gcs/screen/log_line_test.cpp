// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "gcs/screen/shell/error_lines.hpp"

namespace swiftlet::screen {
namespace {

TEST(LogLines, LoseTheirTimeAndColoursAndKeepHowBadTheyAre) {
  const LogLine line =
      parse_log_line("[12:00:00.000] [\x1b[33m\x1b[1mwarning\x1b[m] planner: slow");
  EXPECT_EQ(line.text, "planner: slow");
  EXPECT_EQ(line.severity, Severity::kCaution);
  EXPECT_EQ(parse_log_line("[12:00:00.000] [critical] x: y").severity, Severity::kDanger);
  EXPECT_EQ(parse_log_line("[12:00:00.000] [info] x: y").severity, Severity::kNote);
}

TEST(LogLines, OfOthersStayAsTheyAre) {
  EXPECT_EQ(parse_log_line("terminate called").text, "terminate called");
  EXPECT_EQ(parse_log_line("[a] b").text, "[a] b");
  EXPECT_EQ(parse_log_line("").text, "");
}

}  // namespace
}  // namespace swiftlet::screen
