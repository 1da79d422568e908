// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>

namespace swiftlet {

/// Where the public logs are: SWIFTLET_DATA, or beside the source tree.
inline std::filesystem::path data_folder() {
  const char* given = std::getenv("SWIFTLET_DATA");
  return given != nullptr ? std::filesystem::path(given)
                          : std::filesystem::path(SWIFTLET_SOURCE_DIR) / "../shared/data";
}

}  // namespace swiftlet

#define SWIFTLET_SKIP_WITHOUT(path)   \
  if (!std::filesystem::exists(path)) \
  GTEST_SKIP() << path << " is absent; set SWIFTLET_DATA to the folder of public logs"
