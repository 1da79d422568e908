// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace swiftlet {

/// `swiftlet phone-sim`: sends what a phone would, for people without one.
void add_phone_sim(CLI::App& app);

}  // namespace swiftlet
