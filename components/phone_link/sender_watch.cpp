// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/phone_link/sender_watch.hpp"

namespace swiftlet {

SenderWatch::Verdict SenderWatch::judge(const UdpEndpoint& sender, std::uint32_t session,
                                        std::uint32_t sequence, Time arrival) {
  if (params_.only_from && sender.address != *params_.only_from) return Verdict::kForeign;
  const bool is_phone = phone_ && *phone_ == sender && session_ == session;
  if (!is_phone && !may_take_over(sender, arrival)) return Verdict::kForeign;
  // After a silence the same run of a phone may come from another port; a new run says so by its
  // session, and counts anew.
  const bool is_same_run = phone_ && phone_->address == sender.address && session_ == session;
  const Verdict verdict = is_same_run ? judge_sequence(sequence) : Verdict::kNewPhone;
  if (verdict == Verdict::kRepeated || verdict == Verdict::kReordered) return verdict;
  if (verdict == Verdict::kNewPhone) {
    newest_ = sequence;
    seen_ = 1;
  }
  phone_ = sender;
  session_ = session;
  last_heard_ = arrival;
  return verdict;
}

bool SenderWatch::may_take_over(const UdpEndpoint& sender, Time arrival) const {
  if (!phone_) return true;
  if (to_seconds(arrival - last_heard_) <= params_.silence) return false;
  return params_.any_sender || sender.address == phone_->address;
}

/// Numbers wrap around; of two the later is the one less than half of the way ahead (RFC 1982).
SenderWatch::Verdict SenderWatch::judge_sequence(std::uint32_t sequence) {
  const auto ahead = static_cast<std::int32_t>(sequence - newest_);
  if (ahead > 0) {
    seen_ = ahead < 64 ? seen_ << ahead | 1U : 1U;
    newest_ = sequence;
    return Verdict::kNew;
  }
  const std::uint32_t behind = newest_ - sequence;
  if (behind >= 64) return Verdict::kReordered;
  const std::uint64_t bit = std::uint64_t{1} << behind;
  if ((seen_ & bit) != 0) return Verdict::kRepeated;
  seen_ |= bit;
  return Verdict::kReordered;
}

}  // namespace swiftlet
