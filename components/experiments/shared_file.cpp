// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/experiments/shared_file.hpp"

#include <fmt/format.h>

#include "components/runtime/config/config.hpp"

namespace swiftlet {

std::filesystem::path shared_file(const std::string& name) {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path folders[] = {
      program.parent_path().parent_path() / SWIFTLET_INSTALLED_DATA,
      std::filesystem::path(SWIFTLET_SOURCE_DIR) / "components"};
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::is_regular_file(folder / name, ignored)) return folder / name;
  }
  throw ConfigError(fmt::format("{} is neither in {} nor in {}; install the program again", name,
                                folders[0].string(), folders[1].string()));
}

}  // namespace swiftlet
