// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/topics.hpp"

namespace swiftlet {

/// One line on the terminal that says what the vehicle is doing. Silent where standard error is no
/// terminal.
class Progress : public Component {
 public:
  explicit Progress(const ComponentContext& context);
  ~Progress() override;

 private:
  void print(Time now);

  bool is_terminal_;
  Time begin_;
  swiftlet_msgs::msg::VehicleStatus status_;
};

}  // namespace swiftlet
