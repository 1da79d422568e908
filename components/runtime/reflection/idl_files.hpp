// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace swiftlet {

/// An IDL file that was read.
struct IdlFile {
  std::string name;  ///< for error messages
  std::string text;
};

/// The files in idl/, as they were when the library was built.
const std::vector<IdlFile>& idl_files();

}  // namespace swiftlet
