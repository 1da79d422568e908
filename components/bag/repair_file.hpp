// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "components/bag/mcap/repair.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

struct RepairedFile {
  mcap::Repair repair;
  std::filesystem::path file;                   ///< the sound one
  std::optional<std::filesystem::path> kept{};  ///< where the damaged one is now, if it moved
};

/// Repairs a recording in place, or into `out`, which must not exist. In place, the sound file is
/// written beside the damaged one and takes its name at once, so that there is a file of that name
/// at every moment; the damaged one is kept as FILE.damaged.
Result<RepairedFile> repair_file(const std::filesystem::path& file,
                                 const std::optional<std::filesystem::path>& out);

}  // namespace swiftlet
