// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "components/mode_message.hpp"

namespace swiftlet {

using namespace std::chrono_literals;

Progress::Progress(const ComponentContext& context)
    : Component(context), is_terminal_(isatty(STDERR_FILENO) != 0), begin_(now()) {
  if (!is_terminal_) return;
  subscribe(topic::vehicle_status,
            [this](const swiftlet_msgs::msg::VehicleStatus& status) { status_ = status; });
  every(1s, [this](Time now) { print(now); });
}

Progress::~Progress() {
  if (is_terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::print(Time now) {
  const std::string waypoint =
      status_.waypoint() == 0
          ? ""
          : fmt::format(", waypoint {} of {}", status_.waypoint(), status_.waypoint_count());
  fmt::print(stderr, "\r\033[K{:6.0f} s  {}{}, {:.1f} m up", to_seconds(now - begin_),
             mode_name(status_.mode()), waypoint, status_.height());
}

}  // namespace swiftlet
