// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace swiftlet::screen {

/// Whether the user's locale, by the environment, has UTF-8.
bool locale_is_utf8();

/// Columns of the terminal that standard output is; 80 where it is none.
int terminal_width();

}  // namespace swiftlet::screen
