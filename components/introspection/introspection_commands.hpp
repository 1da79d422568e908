// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

/// Verbs that look at a running system from outside.
namespace swiftlet {

void add_topic_commands(CLI::App& app);
void add_component_commands(CLI::App& app);
void add_param_commands(CLI::App& app);
void add_doctor(CLI::App& app);

}  // namespace swiftlet
