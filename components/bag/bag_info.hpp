// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "components/bag/mcap/verify.hpp"
#include "components/bag/recording.hpp"
#include "components/bag/repair_file.hpp"

namespace swiftlet {

/// What is in a recording, for people and for scripts. With `sizes`, the bytes of each topic before
/// compression, for which the whole file is read.
std::string describe(const Recording& recording, bool sizes = false);
nlohmann::json to_json(const Recording& recording, bool sizes = false);

/// What `verify` found, for scripts. `file` names the recording.
nlohmann::json to_json(const std::string& file, const mcap::Verification& verification);

/// What a repair did.
nlohmann::json to_json(const RepairedFile& repaired);

/// "12.000000000 s", and the date where the clock counts from 1970 as others do.
std::string moment_text(mcap::Timestamp time);
/// "21.8 MB".
std::string size_text(std::uint64_t bytes);

/// The text with control characters replaced: names in a file must not steer the terminal.
std::string printable(std::string text);

}  // namespace swiftlet
