// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "components/runtime/component.hpp"

namespace swiftlet {

/// Waits for a message of one topic, and ends the run: 0 once it was heard, 1 after `patience`
/// without.
template <class T>
class FirstMessage : public Component {
 public:
  FirstMessage(const ComponentContext& context, const Topic<T>& topic, Duration patience)
      : Component(context) {
    subscribe(topic, [this](const T& message) {
      if (message_) return;
      message_ = message;
      stop(0);
    });
    call_at(now() + patience, [this](Time) {
      if (!message_) stop(1);
    });
  }
  const std::optional<T>& message() const { return message_; }

 private:
  std::optional<T> message_;
};

}  // namespace swiftlet
