// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/repair_file.hpp"

#include <string>
#include <utility>

#include "components/bag/recording_records.hpp"

namespace swiftlet {
namespace {

namespace fs = std::filesystem;

/// FILE.damaged, or FILE.damaged2, ... where there are some already.
fs::path free_name(const fs::path& file) {
  std::error_code ignored;
  fs::path name = file.string() + ".damaged";
  for (int i = 2; fs::exists(name, ignored); ++i) {
    name = file.string() + ".damaged" + std::to_string(i);
  }
  return name;
}

/// Gives `file` a second name, or moves it where the file system has no second names.
Status keep(const fs::path& file, const fs::path& name) {
  std::error_code error;
  fs::create_hard_link(file, name, error);
  if (error) fs::rename(file, name, error);
  if (!error) return {};
  return Error{file.string() + ": cannot be kept as " + name.string() + ": " + error.message()};
}

}  // namespace

Result<RepairedFile> repair_file(const fs::path& file, const std::optional<fs::path>& out) {
  const auto source = mcap::open_file(file);
  if (!source.ok()) return source.error();
  std::error_code error;
  if (out && fs::exists(*out, error)) {
    return Error{out->string() + ": exists already; choose another name or remove it first"};
  }
  const fs::path target = out.value_or(file);
  const fs::path beside = target.string() + ".repairing";
  auto repaired = mcap::repair(**source, beside, kRepairRecord);
  if (!repaired.ok()) return repaired.error();
  RepairedFile result{std::move(*repaired), target};
  if (!out) {
    result.kept = free_name(file);
    if (const Status kept = keep(file, *result.kept); !kept.ok()) {
      fs::remove(beside, error);
      return kept.error();
    }
  }
  fs::rename(beside, target, error);
  if (error) return Error{beside.string() + ": cannot be renamed: " + error.message()};
  return result;
}

}  // namespace swiftlet
