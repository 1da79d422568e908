// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace swiftlet {

/// The middleware could not be started or used; `what()` says why and what to do.
class RuntimeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace swiftlet
