// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/mcap/verify.hpp"

#include <algorithm>
#include <utility>

#include "components/bag/mcap/verify_parts.hpp"

namespace swiftlet::mcap {
namespace {

constexpr std::size_t kMaxProblems = 100;

}  // namespace

void Findings::problem(std::string what) {
  if (result_.problems.size() < kMaxProblems) {
    result_.problems.push_back(std::move(what));
  } else if (result_.problems.size() == kMaxProblems) {
    result_.problems.push_back(source_.name() + ": and more problems of the same kinds");
  }
}

void Findings::problem_at(std::uint64_t offset, const std::string& what) {
  problem(error_at(source_, offset, what).reason);
}

void Findings::remark_at(std::uint64_t offset, const std::string& what) {
  result_.remarks.push_back(error_at(source_, offset, what).reason);
}

void Findings::foreign_record(const RawRecord& raw, const std::string& section) {
  if (raw.opcode > Opcode::kDataEnd) {
    ++result_.unknown_records;
  } else {
    problem_at(raw.offset, std::string("a ") + name_of(raw.opcode) +
                               " record does not belong into the " + section);
  }
}

std::optional<std::uint32_t> Findings::crc_of(std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kBlock = 1 << 20;
  std::uint32_t crc = 0;
  while (begin < end) {
    const std::uint64_t length = std::min(kBlock, end - begin);
    if (const Status done = source_.read(begin, length, content_); !done.ok()) {
      problem(done.error().reason);
      return std::nullopt;
    }
    crc = crc32(content_, crc);
    begin += length;
  }
  return crc;
}

Result<Verification> verify(const std::shared_ptr<const ByteSource>& source,
                            const ReaderParams& params) {
  Header header;
  std::uint64_t data_start = 0;
  if (const Status done = read_header(*source, header, data_start); !done.ok()) {
    return done.error();
  }
  Findings findings(*source);
  Footer footer;
  std::uint64_t end = source->size();
  const Status closed = read_footer(*source, footer, end);
  if (!closed.ok()) {
    findings.problem(closed.error().reason);
    end = source->size();
  }
  RecordStream stream(*source, data_start, end);
  Contents contents;
  if (verify_data(stream, params, findings, contents) && closed.ok()) {
    verify_summary(stream, footer, end, findings, contents);
  }
  return std::move(findings.result());
}

}  // namespace swiftlet::mcap
