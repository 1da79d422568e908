// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// The verb `replay`.
void add_replay(CLI::App& app);

}  // namespace swiftlet
