// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/bag/mcap/records.hpp"

/// Records to bytes and back: https://mcap.dev/spec, section "Serialization".
namespace swiftlet::mcap {

/// Appends the whole record (opcode, length, content) to `out`.
void append(Bytes& out, const Header& record);
void append(Bytes& out, const Footer& record);
void append(Bytes& out, const Schema& record);
void append(Bytes& out, const Channel& record);
void append(Bytes& out, const Message& record);
void append(Bytes& out, const Chunk& record);
void append(Bytes& out, const MessageIndex& record);
void append(Bytes& out, const ChunkIndex& record);
/// Computes the checksum of the attachment, too.
void append(Bytes& out, const Attachment& record);
void append(Bytes& out, const AttachmentIndex& record);
void append(Bytes& out, const Statistics& record);
void append(Bytes& out, const Metadata& record);
void append(Bytes& out, const MetadataIndex& record);
void append(Bytes& out, const SummaryOffset& record);
void append(Bytes& out, const DataEnd& record);

/// Reads the content of a record (what follows opcode and length). False where a field does not
/// fit into the content; `record` is then unspecified. Bytes behind the known fields are ignored,
/// as the specification asks. Views in `record` point into `content`.
[[nodiscard]] bool decode(ByteView content, Header& record);
[[nodiscard]] bool decode(ByteView content, Footer& record);
[[nodiscard]] bool decode(ByteView content, Schema& record);
[[nodiscard]] bool decode(ByteView content, Channel& record);
[[nodiscard]] bool decode(ByteView content, Message& record);
[[nodiscard]] bool decode(ByteView content, Chunk& record);
[[nodiscard]] bool decode(ByteView content, MessageIndex& record);
[[nodiscard]] bool decode(ByteView content, ChunkIndex& record);
/// `crc_matches`: the checksum is right, or was not given.
[[nodiscard]] bool decode(ByteView content, Attachment& record, bool& crc_matches);
[[nodiscard]] bool decode(ByteView content, AttachmentIndex& record);
[[nodiscard]] bool decode(ByteView content, Statistics& record);
[[nodiscard]] bool decode(ByteView content, Metadata& record);
[[nodiscard]] bool decode(ByteView content, MetadataIndex& record);
[[nodiscard]] bool decode(ByteView content, SummaryOffset& record);
[[nodiscard]] bool decode(ByteView content, DataEnd& record);

/// Opcode and length of the record at the front of `bytes`, which must have kRecordPrefixSize.
struct RecordPrefix {
  Opcode opcode = Opcode::kHeader;
  std::uint64_t length = 0;
};
RecordPrefix decode_prefix(ByteView bytes);

}  // namespace swiftlet::mcap
