// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/observer.hpp"

#include <fmt/format.h>

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr Duration kTick = 10ms;
/// Participants announce themselves every 50 ms at first; their ends follow at once.
constexpr Duration kAtLeast = 200ms;
constexpr Duration kQuiet = 100ms;
constexpr Duration kAtMost = 600ms;

}  // namespace

Observer::Observer(const ComponentContext& context)
    : Component(context), start_(now()), changed_(start_) {
  every(kTick, [this](Time now) { look(now); });
}

void Observer::look(Time now) {
  if (begun_) return;
  const std::size_t ends = graph().endpoints().size();
  if (ends != seen_) changed_ = now;
  seen_ = ends;
  const Duration waited = now - start_;
  const bool at_rest = waited >= kAtLeast && now - changed_ >= kQuiet && ends > 0;
  if (!at_rest && waited < kAtMost) return;
  first_view_ = view();
  // Who looks may have ends of its own; they are no sign that discovery is done.
  if (first_view_.endpoints.empty() && waited < kAtMost) return;
  begun_ = true;
  begin(first_view_);
}

void Observer::give_up(const std::string& problem, int exit_code) {
  if (problem_.empty()) problem_ = problem;
  stop(exit_code);
}

std::string nothing_there(int domain) {
  return fmt::format(
      "nothing is seen in domain {}. Is it the right one (--domain, ROS_DOMAIN_ID)? Components on "
      "other hosts are seen only with --network ADDRESS, here and there",
      domain);
}

}  // namespace swiftlet
