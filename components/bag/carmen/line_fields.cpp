// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/carmen/line_fields.hpp"

#include <charconv>
#include <cmath>
#include <utility>

namespace swiftlet::carmen {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr double kMaxNumber = 1e12;    // beyond any length, angle or speed of a robot
constexpr double kMaxSeconds = 9.2e9;  // what fits into Time

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

void LineFields::fail(std::string problem) {
  if (problem_.empty()) problem_ = std::move(problem);
}

std::string LineFields::place(std::string_view text, const char* what) const {
  return "field " + std::to_string(index_) + " (" + what + ", \"" +
         std::string(text.substr(0, 40)) + "\")";
}

bool LineFields::at_end() {
  return rest_.find_first_not_of(kBlanks) == std::string_view::npos;
}

std::string_view LineFields::word(const char* what) {
  ++index_;
  const std::size_t start = rest_.find_first_not_of(kBlanks);
  if (start == std::string_view::npos) {
    fail("field " + std::to_string(index_) + " (" + what + ") is missing");
    return {};
  }
  rest_.remove_prefix(start);
  const std::string_view text = rest_.substr(0, rest_.find_first_of(kBlanks));
  rest_.remove_prefix(text.size());
  return text;
}

double LineFields::number(const char* what) {
  const std::string_view text = word(what);
  if (!ok()) return 0.0;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() ||
      !(std::abs(value) <= kMaxNumber)) {
    fail(place(text, what) + " is no finite number");
    return 0.0;
  }
  return value;
}

std::size_t LineFields::count(const char* what, std::size_t max) {
  const std::string_view text = word(what);
  if (!ok()) return 0;
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value > max) {
    fail(place(text, what) + " is no whole number from 0 to " + std::to_string(max));
    return 0;
  }
  return value;
}

Time LineFields::time(const char* what) {
  const std::string_view text = word(what);
  if (!ok()) return {};
  std::int64_t seconds = 0;
  const char* const stop = text.data() + text.size();
  auto [end, error] = std::from_chars(text.data(), stop, seconds);
  const bool plain = error == std::errc() && seconds >= 0 && is_digit(text.front()) &&
                     static_cast<double>(seconds) < kMaxSeconds;
  std::int64_t nanoseconds = 0;
  std::int64_t unit = 100'000'000;
  if (plain && end != stop && *end == '.') {
    for (++end; end != stop && is_digit(*end); ++end, unit /= 10) {
      nanoseconds += unit * (*end - '0');
    }
  }
  if (plain && end == stop) {
    return Time(std::chrono::seconds(seconds) + Duration(nanoseconds));
  }
  double value = 0.0;  // such as 2.5e-05, as printf writes small numbers
  const auto [tail, failure] = std::from_chars(text.data(), stop, value);
  if (failure != std::errc() || tail != stop || !(value >= 0.0) || value >= kMaxSeconds) {
    fail(place(text, what) + " is no time in seconds");
    return {};
  }
  return Time(from_seconds(value));
}

}  // namespace swiftlet::carmen
