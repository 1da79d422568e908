// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Readers that leave in the middle of what is sent to them.
#include "components/runtime/dds/departing_readers.hpp"

#include <gtest/gtest.h>

#include "tests/system/process.hpp"

namespace swiftlet::test {
namespace {

TEST(DepartingReaders, AreSettledInEachProgramOfOurs) {
  EXPECT_TRUE(departing_readers_are_settled());
}

TEST(DepartingReaders, TheirWriterIsNotStuck) {
  const std::string log = ::testing::TempDir() + "departing_readers";
  Process writer({SWIFTLET_DEPARTURE_PEER, "79", "writer"}, {}, log + "_writer");
  Process reader({SWIFTLET_DEPARTURE_PEER, "79", "reader", "150"}, {}, log + "_reader");
  const auto end = reader.wait(Seconds(100.0));
  ASSERT_TRUE(end) << "still waits";
  EXPECT_EQ(end->exit_code, 0) << end->out;
  EXPECT_TRUE(writer.running()) << writer.err();
}

}  // namespace
}  // namespace swiftlet::test
