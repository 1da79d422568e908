// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Text for HTML. Whatever comes out of a recording goes through escaped() on its way into a page.
namespace swiftlet::html {

/// Text that a browser shows as it is: markup in it is none, control characters and bytes that are
/// no UTF-8 are replaced.
std::string escaped(std::string_view text);

/// RFC 4648, with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

/// A row of a table from cells that are HTML. `attributes` go into its tag, with a space in front.
std::string row(const std::vector<std::string>& cells, const std::string& attributes = "");
/// A table with a head of plain words; a column whose word begins with '#' has numbers.
std::string table(const std::vector<std::string>& head, const std::string& rows,
                  const std::string& attributes = "");

}  // namespace swiftlet::html
