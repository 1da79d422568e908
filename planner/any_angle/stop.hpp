// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace swiftlet {

/// Asked now and then by work that could go on: true ends it. Where the answer is that of a clock,
/// results depend on the machine; where it counts, they do not.
using Stop = std::function<bool()>;

}  // namespace swiftlet
