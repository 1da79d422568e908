// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace swiftlet {

/// Notices a call into the middleware that does not come back. Fast DDS 2.9 could stop for ever
/// when a reader left (departing_readers.hpp, where it is kept from it), and other orders of its
/// locks may be as bad: the process then lives, is forgotten by the others, and says nothing. One
/// that ends instead is started again, or another instance takes over.
///
/// One for the process; safe to use from any thread. Entering and leaving take some nanoseconds.
class StuckWatch {
 public:
  /// The calling thread is inside of something that takes microseconds, as long as this lives.
  class Inside {
   public:
    /// `what` outlives this.
    explicit Inside(const char* what);
    ~Inside();
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

   private:
    const char* outer_;
    std::int64_t outer_since_;
  };

  /// To be asked again and again: what a thread has been inside of at every one of the last `times`
  /// questions, if there is such a thing. Questions are counted, not seconds, since a process that
  /// was halted as a whole is not stuck.
  std::optional<std::string> inside_since(int times);

 private:
  struct Seen {
    std::int64_t since = 0;
    int times = 0;
  };
  std::vector<Seen> seen_;  // by slot
};

}  // namespace swiftlet
