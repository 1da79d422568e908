// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/names.hpp"

#include <cctype>

namespace swiftlet {
namespace {

const std::string kPrefix = "rt/";

}  // namespace

Status check_name(const std::string& name) {
  if (name.empty()) return Error{"a name must not be empty"};
  char previous = '/';
  for (const char c : name) {
    const bool alphanumeric = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (!alphanumeric && c != '_' && c != '/') {
      return Error{"'" + name + "' has the character '" + c +
                   "'; names are made of letters, digits, '_' and '/'"};
    }
    if (previous == '/' && (c == '/' || std::isdigit(static_cast<unsigned char>(c)) != 0)) {
      return Error{"'" + name + "': each part between '/' begins with a letter or '_'"};
    }
    previous = c;
  }
  if (previous == '/') return Error{"'" + name + "' ends with '/'"};
  return {};
}

std::string wire_topic(const std::string& vehicle, const std::string& topic) {
  return vehicle.empty() ? kPrefix + topic : kPrefix + vehicle + "/" + topic;
}

std::string topic_of(const std::string& vehicle, const std::string& wire_topic) {
  if (wire_topic.compare(0, kPrefix.size(), kPrefix) != 0) return wire_topic;
  const std::string topic = wire_topic.substr(kPrefix.size());
  const std::string own = vehicle + "/";
  const bool is_own = !vehicle.empty() && topic.compare(0, own.size(), own) == 0;
  return is_own ? topic.substr(own.size()) : topic;
}

}  // namespace swiftlet
