// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace swiftlet {

/// Why something that may fail at run time failed, in a sentence for the person who reads it.
struct Error {
  std::string reason;
};

/// Either a value or the reason why there is none. For failures that a correct program meets at
/// run time (no path, a truncated file). Programming errors are asserts, and configuration that
/// cannot be used throws while it is read.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  const T& value() const& { return assert(ok()), *std::get_if<T>(&content_); }
  T& value() & { return assert(ok()), *std::get_if<T>(&content_); }
  T&& value() && { return assert(ok()), std::move(*std::get_if<T>(&content_)); }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

  /// Only where `!ok()`.
  const Error& error() const { return assert(!ok()), *std::get_if<Error>(&content_); }

 private:
  std::variant<T, Error> content_;
};

/// A result without a value: done, or the reason why not.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error)
      : error_(std::move(error)), ok_(false) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  const Error& error() const { return assert(!ok_), error_; }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace swiftlet
