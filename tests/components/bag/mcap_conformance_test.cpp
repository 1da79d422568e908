// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "components/bag/mcap/reader.hpp"
#include "components/bag/mcap/record_stream.hpp"
#include "components/bag/mcap/verify.hpp"
#include "components/bag/mcap/writer.hpp"
#include "tests/data_folder.hpp"

namespace swiftlet::mcap {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::vector<fs::path> conformance_files() {
  std::vector<fs::path> files;
  const fs::path folder = data_folder() / "mcap/conformance";
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".mcap") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Bytes bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

json expectation(const fs::path& mcap_file) {
  return json::parse(std::ifstream(fs::path(mcap_file).replace_extension(".json")));
}

// --- Records in the form of the JSON files: everything is text ------------------------------

json text(std::uint64_t number) {
  return std::to_string(number);
}

json text(ByteView bytes) {
  json list = json::array();
  for (std::size_t i = 0; i < bytes.size; ++i) list.push_back(std::to_string(bytes.data[i]));
  return list;
}

json text(const std::map<std::uint16_t, std::uint64_t>& map) {
  json object = json::object();
  for (const auto& [key, value] : map) object[std::to_string(key)] = text(value);
  return object;
}

json fields(const Header& r) {
  return {{"library", r.library}, {"profile", r.profile}};
}
json fields(const Footer& r) {
  return {{"summary_crc", text(r.summary_crc)},
          {"summary_offset_start", text(r.summary_offset_start)},
          {"summary_start", text(r.summary_start)}};
}
json fields(const Schema& r) {
  return {{"data", text(r.data)}, {"encoding", r.encoding}, {"id", text(r.id)}, {"name", r.name}};
}
json fields(const Channel& r) {
  return {{"id", text(r.id)},
          {"message_encoding", r.message_encoding},
          {"metadata", r.metadata},
          {"schema_id", text(r.schema_id)},
          {"topic", r.topic}};
}
json fields(const Message& r) {
  return {{"channel_id", text(r.channel_id)},
          {"data", text(r.data)},
          {"log_time", text(r.log_time)},
          {"publish_time", text(r.publish_time)},
          {"sequence", text(r.sequence)}};
}
json fields(const ChunkIndex& r) {
  return {{"chunk_length", text(r.chunk_length)},
          {"chunk_start_offset", text(r.chunk_start_offset)},
          {"compressed_size", text(r.compressed_size)},
          {"compression", r.compression},
          {"message_end_time", text(r.message_end_time)},
          {"message_index_length", text(r.message_index_length)},
          {"message_index_offsets", text(r.message_index_offsets)},
          {"message_start_time", text(r.message_start_time)},
          {"uncompressed_size", text(r.uncompressed_size)}};
}
json fields(const Attachment& r) {
  return {{"create_time", text(r.create_time)},
          {"data", text(r.data)},
          {"log_time", text(r.log_time)},
          {"media_type", r.media_type},
          {"name", r.name}};
}
json fields(const AttachmentIndex& r) {
  return {{"create_time", text(r.create_time)},
          {"data_size", text(r.data_size)},
          {"length", text(r.length)},
          {"log_time", text(r.log_time)},
          {"media_type", r.media_type},
          {"name", r.name},
          {"offset", text(r.offset)}};
}
json fields(const Statistics& r) {
  return {{"attachment_count", text(r.attachment_count)},
          {"channel_count", text(r.channel_count)},
          {"channel_message_counts", text(r.channel_message_counts)},
          {"chunk_count", text(r.chunk_count)},
          {"message_count", text(r.message_count)},
          {"message_end_time", text(r.message_end_time)},
          {"message_start_time", text(r.message_start_time)},
          {"metadata_count", text(r.metadata_count)},
          {"schema_count", text(r.schema_count)}};
}
json fields(const Metadata& r) {
  return {{"metadata", r.metadata}, {"name", r.name}};
}
json fields(const MetadataIndex& r) {
  return {{"length", text(r.length)}, {"name", r.name}, {"offset", text(r.offset)}};
}
json fields(const SummaryOffset& r) {
  return {{"group_length", text(r.group_length)},
          {"group_opcode", text(static_cast<std::uint8_t>(r.group_opcode))},
          {"group_start", text(r.group_start)}};
}
json fields(const DataEnd& r) {
  return {{"data_section_crc", text(r.data_section_crc)}};
}

template <class Record>
json to_json(ByteView content) {
  Record record;
  EXPECT_TRUE(decode(content, record));
  return fields(record);
}

json to_json(Opcode opcode, ByteView content) {
  switch (opcode) {
    case Opcode::kHeader:
      return to_json<Header>(content);
    case Opcode::kFooter:
      return to_json<Footer>(content);
    case Opcode::kSchema:
      return to_json<Schema>(content);
    case Opcode::kChannel:
      return to_json<Channel>(content);
    case Opcode::kMessage:
      return to_json<Message>(content);
    case Opcode::kChunkIndex:
      return to_json<ChunkIndex>(content);
    case Opcode::kAttachment: {
      Attachment record;
      bool crc_matches = false;
      EXPECT_TRUE(decode(content, record, crc_matches));
      EXPECT_TRUE(crc_matches);
      return fields(record);
    }
    case Opcode::kAttachmentIndex:
      return to_json<AttachmentIndex>(content);
    case Opcode::kStatistics:
      return to_json<Statistics>(content);
    case Opcode::kMetadata:
      return to_json<Metadata>(content);
    case Opcode::kMetadataIndex:
      return to_json<MetadataIndex>(content);
    case Opcode::kSummaryOffset:
      return to_json<SummaryOffset>(content);
    case Opcode::kDataEnd:
      return to_json<DataEnd>(content);
    default:
      ADD_FAILURE() << "unexpected record";
      return {};
  }
}

/// All records of a file in the form of the JSON beside it, chunks unpacked.
json records_of(const std::shared_ptr<const ByteSource>& source) {
  json records = json::array();
  const auto add = [&](Opcode opcode, ByteView content) {
    records.push_back({{"type", name_of(opcode)}, {"fields", to_json(opcode, content)}});
  };
  RecordStream stream(*source, sizeof(kMagic), source->size() - sizeof(kMagic));
  Bytes content;
  Bytes unpacked;
  for (;;) {
    const auto record = stream.next();
    if (!record.ok()) {
      ADD_FAILURE() << record.error().reason;
      return records;
    }
    if (!record->has_value()) return records;
    const RawRecord& raw = **record;
    if (raw.opcode == Opcode::kMessageIndex) continue;  // the JSON has none of them
    if (raw.opcode == Opcode::kChunk) {
      Chunk chunk;
      const Status done = read_chunk(*source, raw, kMaxChunkSize, content, chunk, unpacked);
      EXPECT_TRUE(done.ok()) << done.error().reason;
      std::uint64_t position = 0;
      RawRecord inner;
      while (position < unpacked.size() && next_record(unpacked, position, inner)) {
        add(inner.opcode, content_of(unpacked, inner));
      }
      EXPECT_EQ(position, unpacked.size());
      continue;
    }
    EXPECT_TRUE(stream.read(raw, content).ok());
    add(raw.opcode, content);
  }
}

json expected_records(const json& expectation) {
  json records = json::array();
  for (const json& record : expectation["records"]) {
    json object = json::object();
    for (const json& field : record["fields"]) object[field[0].get<std::string>()] = field[1];
    records.push_back({{"type", record["type"]}, {"fields", object}});
  }
  return records;
}

class McapConformance : public testing::Test {
 protected:
  void SetUp() override {
    files_ = conformance_files();
    SWIFTLET_SKIP_WITHOUT(data_folder() / "mcap/conformance");
    ASSERT_GE(files_.size(), 208U);
  }
  std::vector<fs::path> files_;
};

TEST_F(McapConformance, EveryRecordOfEveryFileIsReadAsTheJsonBesideItSays) {
  for (const fs::path& file : files_) {
    EXPECT_EQ(records_of(*open_file(file)), expected_records(expectation(file))) << file;
  }
}

TEST_F(McapConformance, EveryFileIsFoundSound) {
  for (const fs::path& file : files_) {
    const auto result = verify(*open_file(file));
    ASSERT_TRUE(result.ok()) << result.error().reason;
    EXPECT_TRUE(result->problems.empty()) << result->problems.front();
  }
}

/// Reading by index and from the front must give the same messages, and those of the JSON.
TEST_F(McapConformance, MessagesAreThoseOfTheJsonByIndexAndFromTheFront) {
  int indexed = 0;
  for (const fs::path& file : files_) {
    json expected = json::array();
    for (const json& record : expected_records(expectation(file))) {
      if (record["type"] == "Message") expected.push_back(record["fields"]);
    }
    std::stable_sort(expected.begin(), expected.end(), [](const json& a, const json& b) {
      return std::stoull(a["log_time"].get<std::string>()) <
             std::stoull(b["log_time"].get<std::string>());
    });
    for (const bool use_index : {true, false}) {
      ReaderParams params;
      params.use_index = use_index;
      const auto reader = Reader::open(file, params);
      ASSERT_TRUE(reader.ok()) << reader.error().reason;
      EXPECT_TRUE(reader->damage().empty()) << reader->damage().front().reason;
      indexed += reader->indexed() ? 1 : 0;
      EXPECT_EQ(reader->statistics().message_count, expected.size()) << file;
      json messages = json::array();
      MessageCursor cursor = reader->messages();
      for (auto next = cursor.next(); next.ok() && next->has_value(); next = cursor.next()) {
        messages.push_back(fields((*next)->message));
        EXPECT_EQ((*next)->channel->topic, "example");
      }
      EXPECT_EQ(messages, expected) << file << (use_index ? " by index" : " from the front");
    }
  }
  EXPECT_GT(indexed, 10);
}

TEST_F(McapConformance, AttachmentsAndMetadataAreRead) {
  for (const fs::path& file : files_) {
    const auto reader = Reader::open(file);
    ASSERT_TRUE(reader.ok());
    const json expected = expected_records(expectation(file));
    for (const json& record : expected) {
      if (record["type"] == "Attachment") {
        ASSERT_EQ(reader->attachments().size(), 1U) << file;
        EXPECT_EQ(fields(*reader->read(reader->attachments()[0])), record["fields"]);
      }
      if (record["type"] == "Metadata") {
        ASSERT_EQ(reader->metadata().size(), 1U) << file;
        EXPECT_EQ(fields(*reader->read(reader->metadata()[0])), record["fields"]);
      }
    }
  }
}

// --- The writer against the same files ------------------------------------------------------

std::uint64_t number(const json& field) {
  return std::stoull(field.get<std::string>());
}

Bytes bytes_from(const json& list) {
  Bytes bytes;
  for (const json& item : list) bytes.push_back(static_cast<std::uint8_t>(number(item)));
  return bytes;
}

void write_record(Writer& writer, const json& record) {
  const json& f = record["fields"];
  Status done;
  if (record["type"] == "Schema") {
    const auto id = writer.add_schema(f["name"], f["encoding"], bytes_from(f["data"]));
    ASSERT_TRUE(id.ok());
    ASSERT_EQ(*id, number(f["id"]));
  } else if (record["type"] == "Channel") {
    const auto id =
        writer.add_channel(f["topic"], f["message_encoding"],
                           static_cast<std::uint16_t>(number(f["schema_id"])), f["metadata"]);
    ASSERT_TRUE(id.ok());
    ASSERT_EQ(*id, number(f["id"]));
  } else if (record["type"] == "Message") {
    const Bytes data = bytes_from(f["data"]);
    done = writer.write(Message{static_cast<std::uint16_t>(number(f["channel_id"])),
                                static_cast<std::uint32_t>(number(f["sequence"])),
                                number(f["log_time"]), number(f["publish_time"]), data});
  } else if (record["type"] == "Attachment") {
    done = writer.write(Attachment{number(f["log_time"]), number(f["create_time"]), f["name"],
                                   f["media_type"], bytes_from(f["data"])});
  } else if (record["type"] == "Metadata") {
    done = writer.write(Metadata{f["name"], f["metadata"]});
  }
  ASSERT_TRUE(done.ok()) << done.error().reason;
}

/// Everything but the variants that append unknown bytes to records, which a writer must not.
TEST_F(McapConformance, TheWriterMakesTheSameFilesByteForByte) {
  const fs::path made = fs::path(testing::TempDir()) / "conformance_writer.mcap";
  int compared = 0;
  for (const fs::path& file : files_) {
    const json expected = expectation(file);
    std::set<std::string> features;
    for (const json& feature : expected["meta"]["variant"]["features"]) features.insert(feature);
    if (features.count("pad") != 0) continue;
    WriterParams params;
    params.library = "";
    params.compression = Compression::kNone;
    params.overwrite = true;
    params.chunks = features.count("ch") != 0;
    params.message_index = features.count("mx") != 0;
    params.chunk_index = features.count("chx") != 0;
    params.attachment_index = features.count("ax") != 0;
    params.metadata_index = features.count("mdx") != 0;
    params.repeat_schemas = features.count("rsh") != 0;
    params.repeat_channels = features.count("rch") != 0;
    params.statistics = features.count("st") != 0;
    params.summary_offsets = features.count("sum") != 0;
    {
      auto writer = Writer::open(made, params);
      ASSERT_TRUE(writer.ok()) << writer.error().reason;
      for (const json& record : expected_records(expected)) {
        if (record["type"] == "DataEnd") break;
        write_record(*writer, record);
      }
      ASSERT_TRUE(writer->close().ok());
    }
    EXPECT_EQ(bytes_of(made), bytes_of(file)) << file;
    ++compared;
  }
  EXPECT_GE(compared, 98);
  fs::remove(made);
}

TEST(Rosbag2Files, AreReadWholeAndFoundSound) {
  const fs::path folder = data_folder() / "mcap";
  SWIFTLET_SKIP_WITHOUT(folder);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".mcap") continue;
    ++files;
    const auto reader = Reader::open(entry.path());
    ASSERT_TRUE(reader.ok()) << reader.error().reason;
    EXPECT_TRUE(reader->damage().empty());
    EXPECT_EQ(reader->header().profile, "ros2") << entry.path();
    std::map<std::uint16_t, std::uint64_t> counts;
    Timestamp last = 0;
    MessageCursor cursor = reader->messages();
    for (;;) {
      const auto next = cursor.next();
      ASSERT_TRUE(next.ok()) << next.error().reason;
      if (!next->has_value()) break;
      EXPECT_GE((*next)->message.log_time, last);
      last = (*next)->message.log_time;
      EXPECT_EQ((*next)->channel->message_encoding, "cdr");
      ASSERT_GE((*next)->message.data.size, 4U);
      EXPECT_EQ((*next)->message.data.data[1], 1);  // little-endian CDR
      ++counts[(*next)->message.channel_id];
    }
    auto given = reader->statistics().channel_message_counts;
    for (auto it = given.begin(); it != given.end();) {
      it = it->second == 0 ? given.erase(it) : std::next(it);
    }
    EXPECT_EQ(counts, given) << entry.path();
    const auto verified = verify(*open_file(entry.path()));
    ASSERT_TRUE(verified.ok());
    EXPECT_TRUE(verified->problems.empty()) << verified->problems.front();
  }
  EXPECT_GE(files, 4);
}

}  // namespace
}  // namespace swiftlet::mcap
