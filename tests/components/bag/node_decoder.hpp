// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

/// The decoders that Foxglove uses, for tests in C++.
namespace swiftlet {

inline bool succeeds(const std::string& command) {
  return std::system(command.c_str()) == 0;
}

inline std::string quoted(const std::filesystem::path& path) {
  return "'" + path.string() + "'";
}

/// The folder with decode.mjs and its packages, or "" with the reason why there is none.
inline std::filesystem::path decoder(std::string& reason) {
  if (!succeeds("command -v node >/dev/null && command -v npm >/dev/null")) {
    reason = "node or npm is absent: apt install nodejs npm";
    return {};
  }
  const std::filesystem::path source =
      std::filesystem::path(SWIFTLET_SOURCE_DIR) / "tests/components/bag/node";
  const std::filesystem::path folder =
      std::filesystem::path(SWIFTLET_BINARY_DIR) / "tests/components/bag/node";
  std::filesystem::create_directories(folder);
  // Tests run beside each other: the lock lets one of them install, once for each lock file.
  const std::string install =
      "cmp -s package-lock.json installed.json || (npm ci --no-audit "
      "--no-fund >npm.log 2>&1 && cp package-lock.json installed.json)";
  const std::string script = "cd " + quoted(folder) + " && cp -u " + quoted(source) +
                             "/*.json . && cp -u " + quoted(source) + "/decode.mjs . && (" +
                             install + ")";
  if (!succeeds("flock " + quoted(folder / "lock") + " sh -c \"" + script + "\"")) {
    reason = "npm could not install the decoders, see " + (folder / "npm.log").string();
    return {};
  }
  return folder;
}

/// What the decoders make of a file; null where they fail, with their complaint on stderr. Values
/// come of every `every`th message of a topic.
inline nlohmann::json decoded(const std::filesystem::path& decoder_folder,
                              const std::filesystem::path& file, int every = 1) {
  const std::string command = "cd " + quoted(decoder_folder) + " && node decode.mjs " +
                              quoted(file) + " " + std::to_string(every);
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string text;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;) {
    text.append(buffer, n);
  }
  return ::pclose(pipe) == 0 ? nlohmann::json::parse(text) : nlohmann::json();
}

}  // namespace swiftlet
