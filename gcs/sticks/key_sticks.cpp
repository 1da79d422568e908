// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/sticks/key_sticks.hpp"

namespace swiftlet {
namespace {

struct KeyMeaning {
  char key;
  std::size_t stick;  // forward, left, up, turn
  double value;
};
constexpr KeyMeaning kKeys[] = {{'w', 0, 1.0}, {'s', 0, -1.0}, {'a', 1, 1.0}, {'d', 1, -1.0},
                                {'i', 2, 1.0}, {'k', 2, -1.0}, {'j', 3, 1.0}, {'l', 3, -1.0}};

}  // namespace

void KeySticks::press(Key pressed, Time now) {
  if (pressed == key('m')) {
    assisted_ = !assisted_;
    return;
  }
  for (const KeyMeaning& meaning : kKeys) {
    if (pressed != key(meaning.key)) continue;
    sticks_[meaning.stick] = {meaning.value, now};
    return;
  }
  sticks_ = {};
}

Sticks KeySticks::at(Time now) const {
  const auto value = [&](std::size_t i) {
    return now - sticks_[i].pressed < kHold ? sticks_[i].value : 0.0;
  };
  return {value(0), value(1), value(2), value(3), assisted_};
}

}  // namespace swiftlet
