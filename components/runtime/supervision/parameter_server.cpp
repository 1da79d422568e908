// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/parameter_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace swiftlet {
namespace {

using namespace swiftlet_msgs::msg::ParameterRequest_Constants;

constexpr std::size_t kRememberedRequests = 16;

swiftlet_msgs::msg::Parameter to_msg(const ConfigEntry& entry, bool live) {
  swiftlet_msgs::msg::Parameter parameter;
  parameter.name(entry.path);
  parameter.type(entry.type);
  parameter.value(entry.value);
  parameter.limits(entry.limits);
  parameter.live(live);
  return parameter;
}

}  // namespace

void ParameterServer::allow(std::vector<std::string> live, Apply apply) {
  live_ = std::move(live);
  apply_ = std::move(apply);
}

ParameterServer::Reply ParameterServer::answer(const Request& request) {
  for (const Reply& known : answered_) {
    if (known.id() == request.id()) return known;
  }
  Reply reply = carry_out(request);
  reply.id(request.id());
  answered_.push_back(reply);
  if (answered_.size() > kRememberedRequests) answered_.pop_front();
  return reply;
}

ParameterServer::Reply ParameterServer::carry_out(const Request& request) {
  Reply reply;
  if (request.command() == LIST) {
    for (const ConfigEntry& entry : entries_) {
      reply.parameters().push_back(to_msg(entry, is_live(entry.path)));
    }
    reply.accepted(true);
    return reply;
  }
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const ConfigEntry& known) {
    return known.path == request.name();
  });
  if (entry == entries_.end()) {
    std::vector<std::string> names;
    for (const ConfigEntry& known : entries_) names.push_back(known.path);
    const std::string near = nearest_word(request.name(), names);
    reply.reason(fmt::format(
        "there is no parameter '{}'; {}", request.name(),
        near.empty() ? "see: swiftlet param list" : fmt::format("did you mean '{}'?", near)));
    return reply;
  }
  if (request.command() == SET) {
    reply.reason(set(*entry, request.value()));
    if (!reply.reason().empty()) return reply;
  } else if (request.command() != GET) {
    reply.reason(fmt::format("there is no command {}", request.command()));
    return reply;
  }
  reply.parameters().push_back(to_msg(*entry, is_live(entry->path)));
  reply.accepted(true);
  return reply;
}

/// Why the value was not taken; "" where it was.
std::string ParameterServer::set(const ConfigEntry& entry, const std::string& value) {
  if (!is_live(entry.path)) {
    return fmt::format(
        "'{}' is used when the component starts and cannot change while it runs; give it with "
        "--param or --params and start the component again{}",
        entry.path, live_.empty() ? "" : fmt::format(" (live are {})", fmt::join(live_, ", ")));
  }
  try {
    const Config changed = config_.with(entry.path, value);
    apply_(changed);
    for (const ConfigEntry& read : changed.entries()) {
      for (ConfigEntry& known : entries_) {
        if (known.path == read.path) known = read;
      }
    }
    config_ = changed;
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  } catch (const std::invalid_argument& error) {
    return fmt::format("{}={} cannot be used: {}", entry.path, value, error.what());
  }
}

bool ParameterServer::is_live(const std::string& name) const {
  return std::find(live_.begin(), live_.end(), name) != live_.end();
}

}  // namespace swiftlet
