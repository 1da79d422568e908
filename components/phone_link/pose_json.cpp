// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "components/phone_link/pose_fields.hpp"
#include "components/runtime/config/nearest_word.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;

constexpr const char* kChecksumKey = "\"crc32\"";

struct Names {
  std::set<std::string> seen;
  std::string twice;
};

/// What a stranger wrote, fit for a log.
std::string shown(const std::string& name) {
  std::string text = name.substr(0, 40);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

/// Null where the text is no JSON. Of a name that comes twice the last would win, unseen.
json parse(std::string_view text, Names& names) {
  const auto note = [&names](int depth, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::key && depth == 1) {
      const auto& name = parsed.get_ref<const std::string&>();
      if (!names.seen.insert(name).second) names.twice = name;
    }
    return true;
  };
  json object = json::parse(text.begin(), text.end(), note, false);
  return object.is_object() ? object : json();
}

Status read_count(const json& object, const char* name, std::uint32_t& value) {
  const json& field = object[name];
  if (!field.is_number_unsigned() ||
      field.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    return Error{fmt::format("\"{}\" is no whole number of 32 bits", name)};
  }
  value = field.get<std::uint32_t>();
  return {};
}

Status read_numbers(const json& object, const char* name, std::size_t count, double* values) {
  const json& field = object[name];
  const auto fits = [&] {
    return field.is_array() && field.size() == count &&
           std::all_of(field.begin(), field.end(), [](const json& n) { return n.is_number(); });
  };
  if (!fits()) return Error{fmt::format("\"{}\" is no list of {} numbers", name, count)};
  for (std::size_t i = 0; i < count; ++i) values[i] = field[i].get<double>();
  return {};
}

Status check_names(const json& object) {
  const std::vector<std::string> known{"session",     "sequence",   "time", "position",
                                       "orientation", "covariance", "crc32"};
  for (const auto& item : object.items()) {
    if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
    const std::string near = nearest_word(item.key(), known);
    return Error{fmt::format("\"{}\" means nothing here{}", shown(item.key()),
                             near.empty() ? "" : "; did you mean \"" + near + "\"?")};
  }
  for (const char* name : {"sequence", "time", "position", "orientation"}) {
    if (!object.contains(name)) return Error{fmt::format("\"{}\" is missing", name)};
  }
  return {};
}

/// The checksum is the last member and covers all that stands before its name.
Status check_sum(std::string_view text, const json& object) {
  std::uint32_t sum = 0;
  if (Status status = read_count(object, "crc32", sum); !status) return status;
  const std::size_t end = text.find(kChecksumKey);
  const std::string_view rest = text.substr(std::min(end, text.size()));
  if (end == std::string_view::npos || rest.find(',') != std::string_view::npos) {
    return Error{"\"crc32\" is not the last member"};
  }
  if (crc32_of(reinterpret_cast<const std::uint8_t*>(text.data()), end) != sum) {
    return Error{"its checksum does not fit"};
  }
  return {};
}

Status read_pose(const json& object, PhonePose& pose) {
  if (object.contains("session")) {
    if (Status status = read_count(object, "session", pose.session); !status) return status;
  }
  if (Status status = read_count(object, "sequence", pose.sequence); !status) return status;
  if (!object["time"].is_number()) return Error{"\"time\" is no number"};
  const double seconds = object["time"].get<double>();
  if (!(seconds >= 0.0 && seconds <= 4e9)) return Error{"its time is not within 0 and 4e9 s"};
  pose.time = from_seconds(seconds);
  if (Status status = read_numbers(object, "position", 3, pose.position.data()); !status) {
    return status;
  }
  if (Status status = read_numbers(object, "orientation", 4, pose.attitude.coeffs().data());
      !status) {
    return status;
  }
  if (!object.contains("covariance")) return {};
  pose.covariance.emplace();
  return read_numbers(object, "covariance", 36, pose.covariance->data());
}

/// As many digits as it takes to read the same number again.
std::string list_of(const double* values, std::size_t count) {
  return fmt::format("[{}]", fmt::join(values, values + count, ","));
}

}  // namespace

DatagramBytes encode_json(const PhonePose& pose) {
  const std::int64_t nanoseconds = pose.time.count();
  std::string text = fmt::format(
      R"({{"session":{},"sequence":{},"time":{}.{:09},"position":{},"orientation":{},)",
      pose.session, pose.sequence, nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000,
      list_of(pose.position.data(), 3), list_of(pose.attitude.coeffs().data(), 4));
  if (pose.covariance) {
    text += fmt::format(R"("covariance":{},)", list_of(pose.covariance->data(), 36));
  }
  const auto sum = crc32_of(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  text += fmt::format("{}:{}}}", kChecksumKey, sum);
  return {text.begin(), text.end()};
}

Result<PhonePose> decode_json(const std::uint8_t* bytes, std::size_t size, bool needs_checksum) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  Names names;
  json object = parse(text, names);
  if (object.is_null()) return Error{"it begins as JSON, but is no JSON object"};
  if (!names.twice.empty()) {
    return Error{fmt::format("\"{}\" comes twice", shown(names.twice))};
  }
  if (Status status = check_names(object); !status) return status.error();
  if (object.contains("crc32")) {
    if (Status status = check_sum(text, object); !status) return status.error();
  } else if (needs_checksum) {
    return Error{"\"crc32\" is missing; see the parameter 'json'"};
  }
  PhonePose pose;
  if (Status status = read_pose(object, pose); !status) return status.error();
  if (Status status = check_pose(pose); !status) return status.error();
  return pose;
}

}  // namespace swiftlet
