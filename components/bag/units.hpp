// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "estimation/basics/time.hpp"

namespace swiftlet {

/// "200MB", "1.5GB", "4096": bytes, with B, kB, MB, GB or KiB, MiB, GiB. Throws
/// CLI::ValidationError, which names `option`, where it is none, or not more than 0.
std::uint64_t parse_size(const std::string& option, const std::string& text);

/// "30s", "500ms", "10min", "2h", "30": a time, in seconds where it has no unit. Throws as
/// parse_size does.
Duration parse_duration(const std::string& option, const std::string& text);

}  // namespace swiftlet
