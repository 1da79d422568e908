// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/bag/bag_commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "components/bag/recording_writer.hpp"
#include "tests/components/bag/mcap_test_files.hpp"
#include "tests/components/bag/temporary_folder.hpp"
#include "tests/data_folder.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string err;
};

/// Runs `bag <arguments>` as the program does.
Outcome bag(std::vector<std::string> arguments) {
  CLI::App app("bag");
  app.require_subcommand(1);
  add_bag_commands(app);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome outcome;
  try {
    app.parse(arguments);
  } catch (const CLI::RuntimeError& error) {
    outcome.exit_code = error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    outcome.exit_code = app.exit(error) == 0 ? 0 : 2;
  }
  std::fflush(stdout);
  outcome.out = testing::internal::GetCapturedStdout();
  outcome.err = testing::internal::GetCapturedStderr();
  return outcome;
}

class BagCommands : public testing::Test {
 protected:
  void SetUp() override {
    mcap::WriterParams params;
    params.profile = "ros2";
    params.chunk_size = 4000;
    mcap::write_samples(file_, mcap::random_samples(3, 500, 0), params);
  }

  void flip(std::size_t at) {
    auto bytes = read_bytes(file_);
    bytes.at(at) ^= 0x40;
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "f.mcap";
};

TEST_F(BagCommands, InfoPrintsTopicsForPeopleAndScripts) {
  const Outcome text = bag({"info", file_});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("messages     500"));
  EXPECT_THAT(text.out, HasSubstr("test/msg/Blob"));
  EXPECT_THAT(text.err, IsEmpty());

  const json info = json::parse(bag({"info", "--json", file_}).out);
  EXPECT_EQ(info["messages"], 500);
  EXPECT_EQ(info["profile"], "ros2");
  EXPECT_EQ(info["finished"], true);
  ASSERT_EQ(info["topics"].size(), 3U);
  EXPECT_EQ(info["topics"][1]["topic"], "b");
  EXPECT_EQ(info["topics"][0]["messages"].get<int>() + info["topics"][1]["messages"].get<int>() +
                info["topics"][2]["messages"].get<int>(),
            500);
  EXPECT_EQ(info["attachments"][0]["name"], "map.pgm");
  EXPECT_EQ(info["metadata"][0]["values"]["pilot"], "nobody");
  EXPECT_THAT(info["damage"], IsEmpty());
}

TEST_F(BagCommands, InfoCountsTheBytesOfEachTopicWhenAsked) {
  std::map<std::string, std::size_t> bytes;
  for (const auto& sample : mcap::random_samples(3, 500, 0)) {
    bytes[sample.topic] += sample.data.size();
  }
  const json info = json::parse(bag({"info", "--json", "--sizes", file_}).out);
  for (const json& topic : info["topics"]) EXPECT_EQ(topic["size_bytes"], bytes[topic["topic"]]);
  EXPECT_THAT(bag({"info", "--sizes", file_}).out, HasSubstr("rate [Hz]         size\n"));
  EXPECT_FALSE(json::parse(bag({"info", "--json", file_}).out)["topics"][0].contains("size_bytes"));
}

TEST_F(BagCommands, ACutRecordingIsUsableAndSaysWhatItLost) {
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  const Outcome info = bag({"info", file_});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.err, HasSubstr("f.mcap: byte "));
  EXPECT_THAT(info.err, HasSubstr("not closed"));
  const Outcome verify = bag({"verify", file_});
  EXPECT_EQ(verify.exit_code, 1);
  EXPECT_THAT(verify.err, HasSubstr("f.mcap: byte "));
}

TEST_F(BagCommands, ADamagedRecordingIsRefused) {
  flip(std::filesystem::file_size(file_) - 100);  // in the summary
  const Outcome info = bag({"info", file_});
  EXPECT_EQ(info.exit_code, 2);
  EXPECT_THAT(info.err, HasSubstr("the summary is damaged"));
  EXPECT_THAT(info.err, HasSubstr("bag verify"));
}

TEST_F(BagCommands, VerifyNamesThePlaceOfTheDamage) {
  const Outcome sound = bag({"verify", "--json", file_});
  EXPECT_EQ(sound.exit_code, 0);
  EXPECT_EQ(json::parse(sound.out)["sound"], true);
  EXPECT_EQ(json::parse(sound.out)["messages"], 500);

  const auto chunk = mcap::Reader::open(file_)->chunks()[1];
  flip(chunk.chunk_start_offset + chunk.chunk_length / 2);
  const Outcome damaged = bag({"verify", "--json", file_});
  EXPECT_EQ(damaged.exit_code, 1);
  const json found = json::parse(damaged.out);
  EXPECT_EQ(found["sound"], false);
  EXPECT_THAT(found["problems"][0].get<std::string>(),
              HasSubstr("f.mcap: byte " + std::to_string(chunk.chunk_start_offset) + ": chunk"));
  EXPECT_GT(found["messages"], 300);
  EXPECT_LT(found["messages"], 500);
}

TEST_F(BagCommands, WrongUsageAndUnreadableInputExitWithTwo) {
  std::ofstream(folder_ / "ok.log") << "ODOM 0 0 0 0 0 0 1 h 1\n";
  std::ofstream(folder_ / "text.txt") << "hello\n";
  const std::vector<std::vector<std::string>> commands = {
      {"info"},
      {"info", folder_ / "missing.mcap"},
      {"info", folder_ / "text.txt"},
      {"verify", folder_ / "missing.mcap"},
      {"verify", folder_ / "text.txt"},
      {"verify", file_, "--nonsense"},
      {"nonsense"},
      {"convert"},
      {"convert", "carmen", folder_ / "text.txt"},
      {"convert", "carmen", folder_ / "missing.log", "-o", folder_ / "out.mcap"},
      {"convert", "carmen", folder_ / "text.txt", "-o", folder_ / "out.mcap"},
      {"convert", "carmen", file_, "-o", folder_ / "out.mcap"},
      {"convert", "carmen", folder_ / "text.txt", "-o", folder_ / "text.txt"},
      {"convert", "carmen", folder_ / "ok.log", "-o", folder_ / "out.mcap", "--max-range", "nan"},
  };
  for (const auto& command : commands) {
    const Outcome outcome = bag(command);
    EXPECT_EQ(outcome.exit_code, 2) << command.back();
    EXPECT_THAT(outcome.err, testing::Not(IsEmpty())) << command.back();
  }
  EXPECT_THAT(files(), testing::ElementsAre("f.mcap", "ok.log", "text.txt"));
}

TEST_F(BagCommands, ABadLogLeavesNothingHalfWritten) {
  std::ofstream(folder_ / "bad.log") << "ODOM 0 0 0 0 0 0 1 h 1\nFLASER 3 1 1 nan\n";
  const auto before = read_bytes(file_);
  const Outcome outcome = bag({"convert", "carmen", folder_ / "bad.log", "-o", file_});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("bad.log: line 2: FLASER"));
  EXPECT_EQ(read_bytes(file_), before);
  EXPECT_THAT(files(), testing::ElementsAre("bad.log", "f.mcap"));
  EXPECT_EQ(bag({"convert", "carmen", data_folder() / "README.md", "-o", "/proc/x.mcap"}).exit_code,
            2);
}

TEST_F(BagCommands, ARepairedRecordingIsSoundAndTheDamagedOneIsKept) {
  flip(3000);
  EXPECT_EQ(bag({"verify", file_}).exit_code, 1);
  const Outcome repaired = bag({"verify", "--repair", file_});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  EXPECT_THAT(repaired.out,
              HasSubstr("the damaged file is kept as " + file_.string() + ".damaged"));
  EXPECT_THAT(repaired.err, HasSubstr("not saved: "));
  EXPECT_THAT(files(), testing::ElementsAre("f.mcap", "f.mcap.damaged"));
  EXPECT_EQ(bag({"verify", file_}).exit_code, 0);
  EXPECT_EQ(bag({"info", file_}).exit_code, 0);

  // Nothing is left to do.
  const auto before = read_bytes(file_);
  const json again = json::parse(bag({"verify", "--repair", "--json", file_}).out);
  EXPECT_EQ(again["sound"], true);
  EXPECT_FALSE(again.contains("repair"));
  EXPECT_EQ(read_bytes(file_), before);
  EXPECT_THAT(files(), testing::ElementsAre("f.mcap", "f.mcap.damaged"));
}

TEST_F(BagCommands, ARepairIntoAnotherFileTellsScriptsWhatItSaved) {
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  const auto before = read_bytes(file_);
  const Outcome outcome = bag({"verify", "--repair", "-o", folder_ / "g.mcap", "--json", file_});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const json repair = json::parse(outcome.out)["repair"];
  const auto saved = mcap::Reader::open(folder_ / "g.mcap")->statistics().message_count;
  EXPECT_EQ(repair["saved_messages"], saved);
  EXPECT_GT(saved, 100U);
  EXPECT_EQ(read_bytes(file_), before);
  EXPECT_EQ(bag({"verify", "--repair", "-o", folder_ / "g.mcap", file_}).exit_code, 1)
      << "it was replaced";
  EXPECT_EQ(bag({"verify", "-o", folder_ / "h.mcap", file_}).exit_code, 2);
}

TEST_F(BagCommands, WhatIsNoRecordingIsNotRepaired) {
  std::ofstream(folder_ / "text.mcap") << "hello";
  const Outcome outcome = bag({"verify", "--repair", folder_ / "text.mcap"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("text.mcap: byte 0"));
  EXPECT_THAT(files(), testing::ElementsAre("f.mcap", "text.mcap"));
}

TEST_F(BagCommands, SeveralFilesAreOneRecording) {
  RecordingWriterParams params;
  params.file = folder_ / "flight.mcap";
  params.split_duration = std::chrono::milliseconds(100);
  auto writer = RecordingWriter::open(params);
  ASSERT_TRUE(writer->add_topic({"a", "test/msg/A", "", "", {}, false}).ok());
  for (std::uint32_t i = 0; i < 100; ++i) {
    RecordedSample sample;
    sample.sequence = i;
    sample.log_time = 1'000'000'000 + i * 10'000'000ULL;
    ASSERT_TRUE(writer->write(sample).ok());
    if (i == 50) {
      ASSERT_TRUE(writer->note({{"a", {7, 2}}}, sample.log_time).ok());
    }
  }
  ASSERT_TRUE(writer->close().ok());
  std::filesystem::remove(file_);

  const json info = json::parse(bag({"info", "--json", folder_.path()}).out);
  EXPECT_EQ(info["messages"], 100);
  EXPECT_EQ(info["files"].size(), writer->files().size());
  EXPECT_EQ(info["losses"]["dds"], 7);
  EXPECT_EQ(info["losses"]["recorder"], 2);
  EXPECT_EQ(info["topics"][0]["lost"]["dds"], 7);
  const Outcome text = bag({"info", folder_.path()});
  EXPECT_THAT(text.out, HasSubstr("losses       9 messages: DDS lost 7, the recorder 2"));
  EXPECT_THAT(text.out, HasSubstr("files        10"));

  EXPECT_EQ(bag({"verify", folder_.path()}).exit_code, 0);
  std::filesystem::remove(writer->files()[4]);
  const Outcome gap = bag({"verify", folder_.path()});
  EXPECT_EQ(gap.exit_code, 1);
  EXPECT_THAT(gap.err, HasSubstr("part 4 is missing"));
  EXPECT_THAT(bag({"info", folder_.path()}).err, HasSubstr("part 4 is missing"));
}

TEST_F(BagCommands, AnOutputThatCannotBeMadeIsAFailure) {
  std::ofstream(folder_ / "ok.log") << "ODOM 0 0 0 0 0 0 1 h 1\n";
  const Outcome outcome =
      bag({"convert", "carmen", folder_ / "ok.log", "-o", folder_ / "no/x.mcap"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no/x.mcap"));
}

TEST_F(BagCommands, NamesInAFileDoNotSteerTheTerminal) {
  mcap::WriterParams params;
  params.overwrite = true;
  {
    auto writer = mcap::Writer::open(file_, params);
    ASSERT_TRUE(writer->add_channel("\x1b[2Jevil\xff", "cdr", 0).ok());
  }
  EXPECT_EQ(bag({"info", file_}).out.find('\x1b'), std::string::npos);
  EXPECT_THAT(bag({"info", "--json", file_}).out, HasSubstr("evil"));  // and is not UTF-8
}

}  // namespace
}  // namespace swiftlet
