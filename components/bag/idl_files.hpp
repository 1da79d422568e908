// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace swiftlet {

/// The contents of the files in idl/, as they were when the library was built.
const std::vector<std::string>& idl_files();

}  // namespace swiftlet
