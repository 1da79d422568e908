// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Recordings that are cut off, damaged or none.
#include <fstream>
#include <iterator>

#include "components/bag/mcap/reader.hpp"
#include "tests/system/bad_input.hpp"
#include "tests/system/recorded.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;

/// {in} holds, made of one good recording:
///   good.mcap, cut.mcap (its first half), stub.mcap (its first 20 bytes), chunk.mcap (a byte of
///   its second chunk changed), summary.mcap (a byte of its summary changed), text.mcap,
///   empty.mcap.
class DamagedRecording : public BadInputTest {
 protected:
  void SetUp() override {
    const std::string good = path("in/good.mcap");
    write_recording(good);
    std::ifstream stream(good, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    const auto reader = mcap::Reader::open(good);
    ASSERT_TRUE(reader.ok());
    ASSERT_GT(reader->chunks().size(), 5U);
    chunk_ = reader->chunks()[1].chunk_start_offset;
    const std::size_t inside = chunk_ + reader->chunks()[1].chunk_length / 2;
    write("in/cut.mcap", bytes.substr(0, bytes.size() / 2));
    write("in/stub.mcap", bytes.substr(0, 20));
    write("in/chunk.mcap", flipped(bytes, inside));
    write("in/summary.mcap", flipped(bytes, bytes.size() - 100));
    write("in/text.mcap", "hello\n");
    write("in/empty.mcap", "");
  }

  std::uint64_t chunk_ = 0;  ///< where the damaged one begins

 private:
  static std::string flipped(std::string bytes, std::size_t at) {
    bytes[at] = static_cast<char>(bytes[at] ^ 0x40);
    return bytes;
  }
};

class BadRecording : public DamagedRecording, public testing::WithParamInterface<BadInput> {};
TEST_P(BadRecording, IsRefused) {
  expect_refused(GetParam());
}

std::vector<BadInput> every_reader_of_every_file() {
  struct Verb {
    std::string name;
    std::vector<std::string> words;
  };
  const std::vector<Verb> verbs{
      {"Info", {"bag", "info", "{file}"}},
      {"Verify", {"bag", "verify", "{file}"}},
      {"Play", {"bag", "play", "{file}"}},
      {"Replay", {"replay", "{file}", "--into", "lidar_mapper", "--map", "{out}/map.pgm"}},
      {"Convert", {"bag", "convert", "carmen", "{file}", "-o", "{out}/f.mcap"}}};
  std::vector<BadInput> inputs;
  for (const Verb& verb : verbs) {
    for (const std::string file : {"missing", "empty", "text", "stub"}) {
      BadInput input{verb.name + "_" + file, verb.words, {"{in}/" + file + ".mcap: "}};
      for (std::string& word : input.arguments) {
        if (word == "{file}") word = "{in}/" + file + ".mcap";
      }
      inputs.push_back(input);
    }
  }
  return inputs;
}

INSTANTIATE_TEST_SUITE_P(Unreadable, BadRecording, testing::ValuesIn(every_reader_of_every_file()),
                         name_of);

INSTANTIATE_TEST_SUITE_P(Damaged, BadRecording,
                         testing::Values(BadInput{
                             "InfoOfADamagedSummary",
                             {"bag", "info", "{in}/summary.mcap"},
                             {"{in}/summary.mcap: byte ", "summary is damaged", "bag verify"}}),
                         name_of);

INSTANTIATE_TEST_SUITE_P(
    Arguments, BadRecording,
    testing::Values(
        BadInput{"TopicToPlay",
                 {"bag", "play", "{in}/good.mcap", "--topics", "odometri"},
                 {"{in}/good.mcap: ", "no topic 'odometri'", "did you mean 'odometry'?"}},
        BadInput{"TopicToPlayUnknownToAll",
                 {"bag", "play", "{in}/good.mcap", "--topics", "xylophone"},
                 {"{in}/good.mcap: ", "no topic 'xylophone'", "it has odometry, scan"}},
        BadInput{"RateZero", {"bag", "play", "{in}/good.mcap", "--rate", "0"}, {"--rate"}},
        BadInput{"RateNotANumber", {"bag", "play", "{in}/good.mcap", "--rate", "nan"}, {"--rate"}},
        BadInput{"StartNegative", {"bag", "play", "{in}/good.mcap", "--start", "-1"}, {"--start"}},
        BadInput{
            "StartNotANumber", {"bag", "play", "{in}/good.mcap", "--start", "nan"}, {"--start"}},
        BadInput{
            "StartBehindTheEnd", {"bag", "play", "{in}/good.mcap", "--start", "1000"}, {"--start"}},
        BadInput{"PatternThatFitsNothing",
                 {"bag", "play", "{in}/good.mcap", "--topics", "camera/*"},
                 {"{in}/good.mcap: ", "no topic 'camera/*'"}},
        BadInput{"RemapWithoutANewName",
                 {"bag", "play", "{in}/good.mcap", "--remap", "odometry"},
                 {"--remap odometry: ", "old:=new"}},
        BadInput{"RemapOfAnUnknownTopic",
                 {"bag", "play", "{in}/good.mcap", "--remap", "odometri:=odom"},
                 {"no topic 'odometri'", "did you mean 'odometry'?"}},
        BadInput{"RemapToNoName",
                 {"bag", "play", "{in}/good.mcap", "--remap", "odometry:=9 lives"},
                 {"--remap odometry:=9 lives: "}},
        BadInput{"QosOfAnUnknownProfile",
                 {"bag", "play", "{in}/good.mcap", "--qos", "odometry=fast"},
                 {"no profile 'fast'", "sensor, state"}},
        BadInput{
            "ClockThatStands", {"bag", "play", "{in}/good.mcap", "--clock", "0"}, {"--clock: "}},
        BadInput{"RecordOfAPatternThatIsNone",
                 {"bag", "record", "-o", "{out}/f.mcap", "camera/[ab]"},
                 {"no topic has such a name", "--regex"}},
        BadInput{"RecordOfABrokenRegex",
                 {"bag", "record", "-o", "{out}/f.mcap", "--regex", "imu("},
                 {"'imu(' is no regular expression"}},
        BadInput{"RecordInPartsOfNoSize",
                 {"bag", "record", "-o", "{out}/f.mcap", "--split-size", "0MB"},
                 {"--split-size: '0MB' is no size", "200MB"}},
        BadInput{"RecordOfAWindowBeforeNow",
                 {"bag", "record", "-o", "{out}/f.mcap", "--window", "-3s"},
                 {"--window: '-3s' is no time", "30s"}},
        BadInput{"RecordOfAWindowInParts",
                 {"bag", "record", "-o", "{out}/f.mcap", "--window", "3s", "--split-size", "1MB"},
                 {"--split-size"}},
        BadInput{"RecordWithoutMemory",
                 {"bag", "record", "-o", "{out}/f.mcap", "--max-memory", "1kB"},
                 {"--max-memory 1kB: "}},
        BadInput{"RecordOfAWindowIntoNoFolder",
                 {"bag", "record", "-o", "{out}/no/f.mcap", "--window", "3s"},
                 {"no/f.mcap: "}},
        BadInput{"RepairIntoAFileThatIsThere",
                 {"bag", "verify", "{in}/cut.mcap", "-o", "{out}/g.mcap"},
                 {"add --repair"}},
        BadInput{"ReplayIntoAnUnknownComponent",
                 {"replay", "{in}/good.mcap", "--into", "lidar_maper", "--map", "{out}/m.pgm"},
                 {"unknown component 'lidar_maper'", "did you mean 'lidar_mapper'?"}},
        BadInput{"ReplayWithAnUnknownParameter",
                 {"replay", "{in}/good.mcap", "--into", "lidar_mapper", "--map", "{out}/m.pgm",
                  "--param", "lidar_mapper.resolutio=1"},
                 {"did you mean 'resolution'?"}},
        BadInput{"MapOfAnUnknownFormat",
                 {"replay", "{in}/good.mcap", "--into", "lidar_mapper", "--map", "{out}/m.bmp"},
                 {"m.bmp: ", ".pgm or .png"}},
        BadInput{"MapInNoFolder",
                 {"replay", "{in}/good.mcap", "--into", "lidar_mapper", "--map", "{out}/no/m.pgm"},
                 {"no/m.pgm: "}},
        BadInput{"ConvertWithoutALog",
                 {"bag", "convert", "carmen", "{in}/missing.log.gz", "-o", "{out}/f.mcap"},
                 {"{in}/missing.log.gz: "}},
        BadInput{"ConvertOfABrokenLog",
                 {"bag", "convert", "carmen", "{in}/bad.log", "-o", "{out}/f.mcap"},
                 {"{in}/bad.log: line 2: "},
                 {{"bad.log", "ODOM 0 0 0 0 0 0 1 h 1\nFLASER 3 1 1 nan\n"}}}),
    name_of);

/// Ways to read a recording from its front to its end.
std::vector<std::vector<std::string>> readings(const std::string& file) {
  return {{"bag", "play", file, "--rate", "100"}, {"replay", file, "--into", "lidar_mapper"}};
}

TEST_F(DamagedRecording, UndamagedGivesAMap) {
  // So that those which must not write one could have.
  const Finished finished =
      run({"replay", path("in/good.mcap"), "--into", "lidar_mapper", "--map", path("out/map.pgm")});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("550 messages"));
  EXPECT_THAT(left_behind(), testing::UnorderedElementsAre("out/map.pgm", "out/map.yaml"));
}

TEST_F(DamagedRecording, CutOffIsReadUpToThereAndSaysSo) {
  // A recorder that was killed leaves such a file.
  const std::string file = path("in/cut.mcap");
  auto commands = readings(file);
  commands.push_back({"bag", "info", file});
  for (const Arguments& command : commands) {
    SCOPED_TRACE(testing::PrintToString(command));
    const Finished finished = run(command);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr(file + ": byte "));
    EXPECT_THAT(finished.err, HasSubstr("not closed"));
  }
  EXPECT_EQ(run({"bag", "verify", file}).exit_code, 1);
}

TEST_F(DamagedRecording, WithoutItsSummaryIsReadWholeAndSaysSo) {
  const std::string file = path("in/summary.mcap");
  for (const Arguments& command : readings(file)) {
    SCOPED_TRACE(testing::PrintToString(command));
    const Finished finished = run(command);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("550 messages"));
    EXPECT_THAT(finished.err, HasSubstr(file + ": byte "));
    EXPECT_THAT(finished.err, HasSubstr("the summary is damaged"));
  }
}

TEST_F(DamagedRecording, OneDamagedChunkIsNamedAndTheRunFails) {
  const std::string file = path("in/chunk.mcap");
  const std::string place = file + ": byte " + std::to_string(chunk_) + ": chunk";
  auto commands = readings(file);
  commands[1].insert(commands[1].end(), {"--map", path("out/map.pgm")});
  commands.push_back({"bag", "verify", file});
  for (const Arguments& command : commands) {
    SCOPED_TRACE(testing::PrintToString(command));
    const Finished finished = run(command);
    EXPECT_NE(finished.exit_code, 0);  // a script must notice that messages are missing
    EXPECT_THAT(finished.err, HasSubstr(place));
  }
  EXPECT_THAT(left_behind(), testing::IsEmpty());
}

}  // namespace
}  // namespace swiftlet::test
