// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gcs/command/command_sender.hpp"
#include "gcs/screen/state/controller.hpp"

namespace swiftlet::screen {

/// What is sent to the vehicle for an action that is a command.
GroundCommand ground_command(const Action& action);

}  // namespace swiftlet::screen
