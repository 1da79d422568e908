// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The command (of ModeCommand) that leads to a mode, by its name: "Indoor Exploration", however it
/// is spaced and whether in capitals or not, or that of the verb, "explore", and "return". An error
/// names the verb of a mode that needs a place, or all the modes where there is none of that name.
Result<std::uint8_t> command_of_mode(const std::string& name);

/// Those that can be commanded without a place, each as one word, for who completes what is typed.
std::vector<std::string> mode_words();

}  // namespace swiftlet
