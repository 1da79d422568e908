// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/screen/shell/parameter_asker.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "components/runtime/stamp.hpp"

namespace swiftlet::screen {
namespace {

using namespace std::chrono_literals;

constexpr Duration kResend = 200ms;
constexpr Duration kTimeout = 1500ms;

}  // namespace

void ParameterAsker::ask(Request request, Time now) {
  request.id(fmt::format("gcs-param-{}-{}-{}", getpid(), now.time_since_epoch().count(), ++count_));
  request_ = std::move(request);
  deadline_ = now + kTimeout;
  next_send_ = now;
}

bool ParameterAsker::hear(const Reply& reply) {
  if (!request_ || reply.id() != request_->id()) return false;
  request_.reset();
  return true;
}

bool ParameterAsker::advance(Time now) {
  if (!request_) return false;
  if (now > deadline_) {
    request_.reset();
    return true;
  }
  if (now < next_send_ || requests_.matched_readers() == 0) return false;
  request_->header(make_header(now, ""));
  requests_.publish(*request_);
  next_send_ = now + kResend;
  return false;
}

}  // namespace swiftlet::screen
