// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace swiftlet::screen {

/// From now on the terminal is put back as it is now when a signal ends the process that nobody
/// else takes care of: SIGSEGV, SIGABRT (also of an exception that nobody catches), SIGHUP and the
/// like.
void rescue_terminal_at_end();
void forget_rescue();

}  // namespace swiftlet::screen
