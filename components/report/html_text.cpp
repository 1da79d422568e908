// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/html_text.hpp"

#include <fmt/format.h>

namespace swiftlet::html {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the UTF-8 character that begins the text; 0 where none does.
std::size_t character_size(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t size = lead < 0x80   ? 1
                           : lead < 0xC2 ? 0
                           : lead < 0xE0 ? 2
                           : lead < 0xF0 ? 3
                           : lead < 0xF5 ? 4
                                         : 0;
  if (size == 0 || size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool surrogate = lead == 0xED && byte(1) >= 0xA0;
  const bool beyond = lead == 0xF4 && byte(1) >= 0x90;
  return overlong || surrogate || beyond ? 0 : size;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t size = character_size(text);
    const char first = text.front();
    const bool is_control = static_cast<unsigned char>(first) < 0x20 || first == 0x7F;
    if (size == 0 || (is_control && first != '\n' && first != '\t')) {
      out += kReplacement;
    } else if (first == '&') {
      out += "&amp;";
    } else if (first == '<') {
      out += "&lt;";
    } else if (first == '>') {
      out += "&gt;";
    } else if (first == '"') {
      out += "&quot;";
    } else if (first == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(0, size);
    }
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return out;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    std::uint32_t three = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (left > 1) three |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (left > 2) three |= bytes[i + 2];
    out += kDigits[three >> 18 & 63];
    out += kDigits[three >> 12 & 63];
    out += left > 1 ? kDigits[three >> 6 & 63] : '=';
    out += left > 2 ? kDigits[three & 63] : '=';
  }
  return out;
}

std::string row(const std::vector<std::string>& cells, const std::string& attributes) {
  std::string out = "<tr" + attributes + ">";
  for (const std::string& cell : cells) out += "<td>" + cell + "</td>";
  return out + "</tr>\n";
}

std::string table(const std::vector<std::string>& head, const std::string& rows,
                  const std::string& attributes) {
  std::string cells;
  std::string columns;
  for (const std::string& word : head) {
    const bool is_number = !word.empty() && word.front() == '#';
    columns += is_number ? "<col class=\"number\">" : "<col>";
    cells += fmt::format("<th{}>{}</th>", is_number ? " class=\"number\"" : "",
                         escaped(is_number ? word.substr(1) : word));
  }
  return fmt::format(
      "<div class=\"wide\"><table{}><thead><tr>{}</tr></thead>\n<tbody>{}</tbody></table></div>\n",
      attributes, cells, rows);
}

}  // namespace swiftlet::html
