// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// Adds `record` and `play` to the command `bag`, with the conventions of add_bag_commands.
void add_live_bag_commands(CLI::App& bag);

/// Its two parts.
void add_record_command(CLI::App& bag);
void add_play_command(CLI::App& bag);

}  // namespace swiftlet
