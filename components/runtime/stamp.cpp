// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/stamp.hpp"

namespace swiftlet {

builtin_interfaces::msg::Time to_msg(Time time) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  const std::int64_t nanoseconds = time.time_since_epoch().count();
  // Rounded down, so that nanosec is never negative.
  std::int64_t seconds = nanoseconds / kNanosecondsPerSecond;
  if (nanoseconds % kNanosecondsPerSecond < 0) --seconds;
  builtin_interfaces::msg::Time stamp;
  stamp.sec(static_cast<std::int32_t>(seconds));
  stamp.nanosec(static_cast<std::uint32_t>(nanoseconds - seconds * kNanosecondsPerSecond));
  return stamp;
}

Time from_msg(const builtin_interfaces::msg::Time& stamp) {
  return Time(std::chrono::seconds(stamp.sec()) + std::chrono::nanoseconds(stamp.nanosec()));
}

std_msgs::msg::Header make_header(Time time, const std::string& frame) {
  std_msgs::msg::Header header;
  header.stamp(to_msg(time));
  header.frame_id(frame);
  return header;
}

}  // namespace swiftlet
