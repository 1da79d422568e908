// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "gcs/mission/json_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gcs/mission/line_problem.hpp"

namespace swiftlet {
namespace {

constexpr std::size_t kMostLevels = 64;
constexpr std::size_t kMostKeys = 256;  // of one object

/// Where the parser is. White space does not count: the parser reads one character behind a number
/// to know its end.
struct Place {
  int newlines = 0;
  int line = 1;  ///< of the last character that is no white space
};

/// Walks through a text, and tells where it is.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Place* place) : at_(at), place_(place) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    const char c = *at_++;
    if (c == '\n') ++place_->newlines;
    const bool is_white = c == '\n' || c == '\r' || c == '\t' || c == ' ';
    if (!is_white) place_->line = place_->newlines + 1;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  Place* place_;
};

/// nlohmann's "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ..."
std::string reason_of(const nlohmann::json::exception& error) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  return colon == std::string::npos ? text : text.substr(colon + 2);
}

}  // namespace

/// Takes the parser's events (nlohmann::json_sax), and makes values with lines of them.
class JsonBuilder {
 public:
  explicit JsonBuilder(const Place& place) : place_(place) {}
  JsonValue take() { return std::move(top_); }

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(std::int64_t value) { return add(value); }
  bool number_unsigned(std::uint64_t value) { return add(value); }
  bool number_float(double value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(nlohmann::json::binary_t&) { return false; }  // JSON has none

  bool start_object(std::size_t) { return open(JsonValue::Kind::kObject); }
  bool start_array(std::size_t) { return open(JsonValue::Kind::kList); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    std::vector<std::string>& keys = open_.back()->keys_;
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) {
      throw LineProblem(place_.line, fmt::format("'{}' is given twice; keep one", name));
    }
    if (keys.size() >= kMostKeys) {
      throw LineProblem(
          place_.line,
          fmt::format("an object with more than {} keys; is it a mission?", kMostKeys));
    }
    keys.push_back(std::move(name));
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    throw LineProblem(place_.line, "not valid JSON: " + reason_of(error));
  }

 private:
  JsonValue& place_new() {
    if (open_.empty()) return top_;
    return open_.back()->values_.emplace_back();
  }
  bool add(nlohmann::json scalar) {
    JsonValue& value = place_new();
    value.line_ = place_.line;
    value.scalar_ = std::move(scalar);
    return true;
  }
  bool open(JsonValue::Kind kind) {
    if (open_.size() >= kMostLevels) {
      throw LineProblem(
          place_.line,
          fmt::format("nested more than {} levels deep; is it a mission?", kMostLevels));
    }
    JsonValue& value = place_new();
    value.line_ = place_.line;
    value.kind_ = kind;
    open_.push_back(&value);  // only its own members are added to until it is closed
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const Place& place_;
  JsonValue top_;
  std::vector<JsonValue*> open_;
};

JsonValue parse_json(const std::string& text) {
  Place place;
  JsonBuilder builder(place);
  const CountingIterator begin(text.data(), &place);
  const CountingIterator end(text.data() + text.size(), &place);
  if (!nlohmann::json::sax_parse(begin, end, &builder)) {
    throw LineProblem(place.line, "not valid JSON");
  }
  return builder.take();
}

const JsonValue* JsonValue::find(const std::string& key) const {
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  return found == keys_.end() ? nullptr : &values_[static_cast<std::size_t>(found - keys_.begin())];
}

const JsonValue& JsonValue::at(const std::string& key) const {
  if (!is_object()) {
    throw LineProblem(line_,
                      fmt::format("expected an object with '{}', found {}", key, describe()));
  }
  if (const JsonValue* value = find(key)) return *value;
  throw LineProblem(line_, fmt::format("'{}' is missing here; add it", key));
}

const std::vector<JsonValue>& JsonValue::list() const {
  if (!is_list()) throw LineProblem(line_, "expected a list, found " + describe());
  return values_;
}

double JsonValue::number() const {
  if (kind_ != Kind::kScalar || !scalar_.is_number()) {
    throw LineProblem(line_, "expected a number, found " + describe());
  }
  return scalar_.get<double>();  // the parser refuses what is too large for one
}

int JsonValue::whole() const {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > 1e9) {
    throw LineProblem(line_, "expected a whole number, found " + describe());
  }
  return static_cast<int>(value);
}

bool JsonValue::truth() const {
  if (kind_ != Kind::kScalar || !scalar_.is_boolean()) {
    throw LineProblem(line_, "expected true or false, found " + describe());
  }
  return scalar_.get<bool>();
}

const std::string& JsonValue::text() const {
  if (kind_ != Kind::kScalar || !scalar_.is_string()) {
    throw LineProblem(line_, "expected a text, found " + describe());
  }
  return scalar_.get_ref<const std::string&>();
}

std::string JsonValue::describe() const {
  if (is_list()) return "a list";
  if (is_object()) return "an object";
  if (scalar_.is_string()) return fmt::format("'{}'", scalar_.get_ref<const std::string&>());
  return scalar_.dump();
}

}  // namespace swiftlet
