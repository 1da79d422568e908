// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace swiftlet {

/// Fast DDS 2.9 locks itself up for good when a reader leaves while samples wait to be sent to it
/// again: matched_reader_remove() holds the locators of a reliable, volatile writer and asks for
/// the lock of the sending thread, to take back what nobody waits for any more; that thread holds
/// its lock and asks for the locators, to send what it has put together. (Upstream: pull request
/// 3468; Debian 12 has a version from before it.)
///
/// So matched_reader_remove() is replaced by one that settles first, without the locators, what the
/// reader would still have had to acknowledge, and then does what it always did: nothing is left to
/// be taken back. The dynamic linker prefers a program's own function to that of a library.
///
/// Whether it does so here; false in a program that gets this code from a shared library.
bool departing_readers_are_settled();

}  // namespace swiftlet
