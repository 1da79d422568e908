// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/introspection/echo.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "components/runtime/reflection/cdr_decoder.hpp"
#include "components/runtime/reflection/value_text.hpp"

namespace swiftlet {

Echo::Echo(const ComponentContext& context, const EchoParams& params)
    : TopicObserver(context, params.topic), params_(params) {}

bool Echo::open(const TopicView& topic, const std::string& type) {
  type_ = params_.types->find(type);
  if (type_ == nullptr) {
    give_up(fmt::format(
        "'{}' has the type {}, which this program does not know; give its definition with --idl "
        "FILE.idl, or add it to idl/ and build. Its rate and size can be had without: swiftlet "
        "topic hz, swiftlet topic bw",
        topic.name, ros_type_name(type)));
    return false;
  }
  if (params_.field.empty()) return true;
  auto field = FieldPath::parse(*type_, params_.field);
  if (!field.ok()) {
    give_up(field.error().reason, 2);
    return false;
  }
  field_ = std::move(field).value();
  return true;
}

void Echo::sample(const Cdr& cdr, Time) {
  if (params_.count > 0 && printed_ == params_.count) return;
  Result<Value> value = decode(*type_, cdr);
  if (value.ok() && field_) value = field_->select(*value);
  if (!value.ok()) {
    log()->warn("a message that cannot be shown: {}", value.error().reason);
    return;
  }
  print(*value);
  if (++printed_ == params_.count) stop(0);
}

void Echo::print(const Value& value) const {
  if (params_.json) {
    using nlohmann::ordered_json;
    constexpr auto replace = ordered_json::error_handler_t::replace;
    fmt::print("{}\n", to_json(value, params_.lists).dump(-1, ' ', false, replace));
  } else {
    TextOptions options;
    if (params_.full_length) options.longest = 0;
    options.lists = params_.lists;
    fmt::print("{}---\n", to_yaml(value, options));
  }
  std::fflush(stdout);
}

}  // namespace swiftlet
