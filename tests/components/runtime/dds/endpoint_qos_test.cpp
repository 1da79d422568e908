// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/dds/endpoint_qos.hpp"

#include <gtest/gtest.h>

#include "components/runtime/qos.hpp"

namespace swiftlet::test {
namespace {

namespace dds = eprosima::fastdds::dds;

TEST(EndpointQos, LargeSamplesThatSomebodyWaitsForHaveASendingThread) {
  const auto mode = [](const QosProfile& profile, const EndpointPlace& place) {
    const EndpointSpec spec{"rt/scan", "std_msgs::msg::dds_::Header_", profile, "tester", nullptr};
    return writer_qos(spec, place, nullptr).publish_mode().kind;
  };
  const EndpointPlace here{}, far{false, false, true}, isolated{true, false, false};
  for (const QosProfile& large : {qos::bulk, qos::map}) {
    EXPECT_EQ(mode(large, isolated), dds::SYNCHRONOUS_PUBLISH_MODE) << large.name;
    EXPECT_EQ(mode(large, far), dds::ASYNCHRONOUS_PUBLISH_MODE) << large.name;
  }
  EXPECT_EQ(mode(qos::bulk, here), dds::SYNCHRONOUS_PUBLISH_MODE);
  EXPECT_EQ(mode(qos::map, here), dds::ASYNCHRONOUS_PUBLISH_MODE);
  EXPECT_EQ(mode(qos::state, far), dds::SYNCHRONOUS_PUBLISH_MODE);
}

}  // namespace
}  // namespace swiftlet::test
