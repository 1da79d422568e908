// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace swiftlet {

/// Text that is the same in every report.
struct PageAsset {
  std::string text;
  std::string sha256;  ///< of the text, in hexadecimal digits
};
const PageAsset& page_style();
const PageAsset& page_script();

}  // namespace swiftlet
