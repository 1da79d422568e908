// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/succession.hpp"

#include <algorithm>
#include <tuple>

namespace swiftlet {
namespace {

constexpr int kSilentPeriods = 3;

bool comes_before(const Succession::Sign& a, const Succession::Sign& b) {
  return std::tie(a.standby, a.instance) < std::tie(b.standby, b.instance);
}

/// Of two active instances, the one that stays.
bool outranks(const Succession::Sign& a, const Succession::Sign& b) {
  return a.term != b.term ? a.term > b.term : comes_before(a, b);
}

}  // namespace

Succession::Succession(const Sign& self, Duration period, Duration settle, Time begin)
    : self_(self), silence_(kSilentPeriods * period), settled_(begin + settle) {
  self_.active = false;
}

void Succession::heard(const Sign& sign, Time now) {
  if (sign.instance == self_.instance) return;
  others_[sign.instance] = {sign, now};
  highest_term_ = std::max(highest_term_, sign.term);
  if (sign.active) settled_ = std::min(settled_, now);  // they find each other
}

bool Succession::update(Time now) {
  for (auto other = others_.begin(); other != others_.end();) {
    const bool silent = now - other->second.heard > silence_;
    other = silent ? others_.erase(other) : std::next(other);
  }
  const bool was_active = self_.active;
  if (const Sign* other = leader()) {
    if (self_.active && outranks(*other, self_)) self_.active = false;
  } else if (!self_.active && is_next(now)) {
    self_.active = true;
    self_.term = highest_term_ + 1;
    highest_term_ = self_.term;
  }
  return self_.active != was_active;
}

const Succession::Sign* Succession::leader() const {
  const Sign* leader = nullptr;
  for (const auto& [instance, other] : others_) {
    if (!other.sign.active) continue;
    if (leader == nullptr || outranks(other.sign, *leader)) leader = &other.sign;
  }
  return leader;
}

bool Succession::is_next(Time now) const {
  if (now < settled_) return false;
  return std::none_of(others_.begin(), others_.end(),
                      [this](const auto& entry) { return comes_before(entry.second.sign, self_); });
}

}  // namespace swiftlet
