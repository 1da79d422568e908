// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/supervision/parameter_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace swiftlet {
namespace {

using namespace swiftlet_msgs::msg::ParameterRequest_Constants;
using namespace swiftlet_msgs::msg::Parameter_Constants;

constexpr std::size_t kRememberedRequests = 16;

swiftlet_msgs::msg::Parameter to_msg(const ConfigEntry& entry, std::uint8_t changes) {
  swiftlet_msgs::msg::Parameter parameter;
  parameter.name(entry.path);
  parameter.type(entry.type);
  parameter.value(entry.value);
  parameter.limits(entry.limits);
  parameter.changes(changes);
  return parameter;
}

}  // namespace

void ParameterServer::allow(ChangeableParameters changeable) {
  for (const auto* names : {&changeable.at_any_time, &changeable.on_ground}) {
    for (const std::string& name : *names) {
      const bool is_read =
          std::any_of(entries_.begin(), entries_.end(),
                      [&name](const ConfigEntry& entry) { return entry.path == name; });
      if (!is_read) throw std::invalid_argument("nobody reads the parameter '" + name + "'");
    }
  }
  changeable_ = std::move(changeable);
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
      reply.parameters().push_back(to_msg(entry, changes(entry.path)));
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
  reply.parameters().push_back(to_msg(*entry, changes(entry->path)));
  reply.accepted(true);
  return reply;
}

/// Why the value was not taken; "" where it was.
std::string ParameterServer::set(const ConfigEntry& entry, const std::string& value) {
  const std::uint8_t when = changes(entry.path);
  if (when == AT_START) {
    return fmt::format(
        "'{}' is used when the component starts and cannot change while it runs; give it with "
        "--param or --params and start the component again",
        entry.path);
  }
  if (when == ON_GROUND && changeable_.flies && changeable_.flies()) {
    return fmt::format("'{}' may change before lift-off, not in flight; land first", entry.path);
  }
  try {
    const Config changed = config_.with(entry.path, value);
    changeable_.apply(changed);
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

std::uint8_t ParameterServer::changes(const std::string& name) const {
  const auto is_among = [&name](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (is_among(changeable_.at_any_time)) return AT_ANY_TIME;
  return is_among(changeable_.on_ground) ? ON_GROUND : AT_START;
}

}  // namespace swiftlet
