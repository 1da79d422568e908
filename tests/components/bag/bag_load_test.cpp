// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// What a recorder must bear: much at once, a kill at any moment, a disk that is full. Another
// process publishes samples with numbers in them; what is missing among those numbers in the file
// is what the file's ledger must say. SWIFTLET_FULL_TESTS=1: for a minute, and ten kills.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "components/bag/recording.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Number and log time of each recorded sample of bag_load, by topic.
using Numbers = std::map<std::string, std::vector<std::pair<std::uint64_t, mcap::Timestamp>>>;

Numbers numbers_in(const Recording& recording) {
  Numbers numbers;
  auto cursor = recording.messages();
  for (auto next = cursor.next(); !next.ok() || *next; next = cursor.next()) {
    if (!next.ok()) {
      ADD_FAILURE() << next.error().reason;
      continue;
    }
    std::uint64_t number = 0;
    std::memcpy(&number, (*next)->message.data.data + 4, sizeof(number));
    numbers[(*next)->channel->topic].emplace_back(number, (*next)->message.log_time);
  }
  return numbers;
}

struct Usage {
  double cpu_s = 0.0;
  double peak_mb = 0.0;
};

Usage usage_of(pid_t process) {
  Usage usage;
  const std::string folder = "/proc/" + std::to_string(process);
  std::ifstream status(folder + "/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:" && status >> usage.peak_mb) usage.peak_mb /= 1000.0;
  }
  std::ifstream stat(folder + "/stat");
  std::string line;
  std::getline(stat, line);
  std::istringstream fields(line.substr(line.rfind(')') + 2));
  std::vector<std::string> words{std::istream_iterator<std::string>(fields), {}};
  // utime and stime are fields 14 and 15; the third is the first behind the name.
  usage.cpu_s = (std::stod(words.at(11)) + std::stod(words.at(12))) /
                static_cast<double>(sysconf(_SC_CLK_TCK));
  return usage;
}

mcap::Timestamp time_of_day() {
  return static_cast<mcap::Timestamp>(
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count());
}

class BagLoad : public test::SystemTest {
 protected:
  struct Load {
    int topics = 1;
    int bytes = 100;
    int hz = 1000;
    double seconds = 5.0;
    const char* reliability = "reliable";
  };

  test::Process record(const std::vector<std::string>& more = {}) {
    // Others may be talking in this domain, too.
    std::vector<std::string> command = {"bag", "record", "-o", file_, "load_*"};
    command.insert(command.end(), more.begin(), more.end());
    return start(command);
  }

  test::Process publish(const Load& load) {
    return start_command({BAG_LOAD, std::to_string(domain()), std::to_string(load.topics),
                          std::to_string(load.bytes), std::to_string(load.hz),
                          std::to_string(load.seconds), load.reliability});
  }

  /// Records all of a load, and says what it took.
  void record_all(const Load& load, double& cores, double& peak_mb) {
    test::Process recorder = record();
    test::Process speaker = publish(load);
    const auto spoken = speaker.wait(test::Seconds(load.seconds + 60.0));
    ASSERT_TRUE(spoken && spoken->exit_code == 0) << speaker.err();
    const Usage usage = usage_of(recorder.id());
    cores = usage.cpu_s / load.seconds;
    peak_mb = usage.peak_mb;
    expect_end(recorder, SIGINT, 0);
    spoken_ = std::stoull(spoken->out);
    std::printf("%d samples/s of %d bytes: %.2f cores, %.0f MB at most\n", load.hz, load.bytes,
                cores, peak_mb);
  }

  void expect_nothing_lost() {
    const auto recording = Recording::open({file_});
    ASSERT_TRUE(recording.ok()) << recording.error().reason;
    EXPECT_EQ(losses_of(*recording), LossLedger());
    std::set<std::uint64_t> numbers;
    for (const auto& [topic, recorded] : numbers_in(*recording)) {
      EXPECT_EQ(topic.rfind("load_", 0), 0U) << topic;
      for (const auto& [number, time] : recorded) {
        EXPECT_LT(number, spoken_) << topic;
        EXPECT_TRUE(numbers.insert(number).second) << topic << " " << number << " came twice";
        if (HasFailure()) return;
      }
    }
    EXPECT_EQ(numbers.size(), spoken_);
  }

  /// The ledger of a file counts what is missing between the samples up to its own time; whether
  /// samples in front of the first one after it are in it, too, depends on the moment.
  void expect_ledger_is_right(const Recording& recording) {
    const auto record = metadata_named(recording, kLossRecord);
    ASSERT_TRUE(record);
    const mcap::Timestamp noted = std::stoull(record->metadata.at("time"));
    const LossLedger ledger = ledger_of(*record).value();
    for (const auto& [topic, recorded] : numbers_in(recording)) {
      std::uint64_t least = 0, most = 0;
      bool is_bounded = false;
      for (std::size_t i = 1; i < recorded.size() && !is_bounded; ++i) {
        most += recorded[i].first - recorded[i - 1].first - 1;
        is_bounded = recorded[i].second > noted;
        if (!is_bounded) least = most;
      }
      const auto found = ledger.find(topic);
      const std::uint64_t said = found == ledger.end() ? 0 : found->second.total();
      EXPECT_GE(said, least) << topic;
      if (is_bounded) {
        EXPECT_LE(said, most) << topic;
      }
    }
  }

  const double seconds_ = test::full_tests() ? 60.0 : 5.0;
  std::string file_ = path("f.mcap");
  std::uint64_t spoken_ = 0;
};

/// What waits may take 256 MB; the rest is the program and the middleware.
constexpr double kMostMemoryMb = 256.0 + 150.0;

TEST_F(BagLoad, TwentyThousandSmallSamplesASecondAreRecordedOnACore) {
  double cores = 0.0, peak_mb = 0.0;
  record_all({8, 100, 20'000, seconds_, "reliable"}, cores, peak_mb);
  expect_nothing_lost();
  if (test::kSlowdown == 1) {  // a sanitizer keeps what is freed for a while
    EXPECT_LT(peak_mb, kMostMemoryMb);
    EXPECT_LT(cores, 1.0);
  }
}

TEST_F(BagLoad, AHundredAndTwentyMegabytesASecondAreRecordedOnACore) {
  double cores = 0.0, peak_mb = 0.0;
  if (test::kSlowdown > 1) GTEST_SKIP() << "not at the speed of a sanitizer";
  record_all({2, 1'000'000, 120, seconds_, "reliable"}, cores, peak_mb);
  expect_nothing_lost();
  EXPECT_LT(peak_mb, kMostMemoryMb);
  EXPECT_LT(cores, 1.0);
}

TEST_F(BagLoad, MoreThanTheNetworkBearsIsInTheLedger) {
  // What takes a slow program minutes to send is too much for it in a shorter time, too.
  const double seconds = test::kSlowdown == 1 ? 3.0 : 0.5;
  for (const char* reliability : {"best_effort", "reliable"}) {
    test::Process recorder = record({"--overwrite", "--max-memory", "8MB"});
    test::Process speaker = publish({1, 1'000'000, 1000, seconds, reliability});
    const auto spoken = speaker.wait(test::Seconds(120.0));
    ASSERT_TRUE(spoken && spoken->exit_code == 0) << speaker.err();
    expect_end(recorder, SIGINT, 0);
    const auto recording = Recording::open({file_});
    ASSERT_TRUE(recording.ok());
    expect_ledger_is_right(*recording);
    // All is noted when the file is closed: between the first and the last sample in it nothing
    // is unaccounted for. Behind the last, some may have been dropped.
    const auto numbers = numbers_in(*recording).at("load_0");
    const Loss loss = losses_of(*recording)->at("load_0");
    EXPECT_GT(loss.total(), 0U) << "this was not too much for the network, nothing is tested";
    const std::uint64_t accounted = numbers.size() + loss.total();
    EXPECT_GE(accounted, numbers.back().first - numbers.front().first + 1);
    EXPECT_LE(accounted, std::stoull(spoken->out) - numbers.front().first);
    const json lost = json::parse(run({"bag", "info", "--json", file_}).out)["topics"][0]["lost"];
    EXPECT_EQ(lost["dds"], loss.by_dds);
    EXPECT_EQ(lost["recorder"], loss.by_recorder);
  }
}

TEST_F(BagLoad, KilledAtAnyMomentLosesASecondAtMostAndTheLedgerIsRight) {
  // The contract is one second; the rest is for a machine that does other things, too.
  constexpr mcap::Timestamp kContract = 1'000'000'000, kSlack = 500'000'000;
  const int kills = test::full_tests() ? 10 : 3;
  std::mt19937 random(17);
  for (int i = 0; i < kills; ++i) {
    // Small samples that all arrive, or large ones of which the network loses some.
    const bool lossy = i % 2 == 1;
    file_ = path("killed_" + std::to_string(i) + ".mcap");
    test::Process recorder = record();
    test::Process speaker = publish(lossy ? Load{1, 500'000, 1200, 20.0, "best_effort"}
                                          : Load{4, 200, 4000, 20.0, "reliable"});
    ASSERT_TRUE(test::becomes_true(test::kStartLimit, [&] {
      const auto recording = Recording::open({file_});
      return recording.ok() && recording->statistics().message_count > 100;
    })) << recorder.err();
    const auto moment = std::chrono::milliseconds(random() % 2000);
    std::this_thread::sleep_for(moment);  // the random moment; nothing is hoped for
    const mcap::Timestamp killed = time_of_day();
    expect_end(recorder, SIGKILL, 128 + SIGKILL);
    speaker.send(SIGKILL);

    const auto recording = Recording::open({file_});
    ASSERT_TRUE(recording.ok()) << recording.error().reason;
    const mcap::Timestamp last = recording->statistics().message_end_time;
    const mcap::Timestamp lost = killed - std::min(killed, last);
    std::printf("the last %.2f s are lost\n", 1e-9 * static_cast<double>(lost));
    EXPECT_LT(lost, kContract + kSlack * test::kSlowdown);
    expect_ledger_is_right(*recording);

    const auto before = numbers_in(*recording);
    EXPECT_EQ(run({"bag", "verify", file_}).exit_code, 1);
    const auto repaired = run({"bag", "verify", "--repair", file_});
    EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
    EXPECT_EQ(run({"bag", "verify", file_}).exit_code, 0);
    const auto sound = Recording::open({file_});
    EXPECT_TRUE(sound->finished());
    EXPECT_TRUE(numbers_in(*sound) == before) << "a repair changed what could be read";
    EXPECT_EQ(losses_of(*sound), losses_of(*recording));
  }
}

TEST_F(BagLoad, AFullDiskEndsTheRecordingAndKeepsWhatIsOnIt) {
  constexpr std::uintmax_t kRoom = 3'000'000;
  test::Process recorder = start_command({"prlimit", "--fsize=" + std::to_string(kRoom), "env",
                                          "--ignore-signal=XFSZ", SWIFTLET_PROGRAM, "bag", "record",
                                          "-o", file_, "load_*", "--compression", "none"});
  test::Process speaker = publish({1, 10'000, 500, 20.0, "reliable"});
  const auto ended = recorder.wait(test::Seconds(30.0));
  ASSERT_TRUE(ended) << "goes on without a disk";
  EXPECT_EQ(ended->exit_code, 1);
  EXPECT_THAT(ended->err, HasSubstr("recording stopped: " + file_ + ": byte "));
  EXPECT_THAT(ended->err, HasSubstr("File too large"));
  const auto recording = Recording::open({file_});
  ASSERT_TRUE(recording.ok());
  const auto numbers = numbers_in(*recording).at("load_0");
  EXPECT_GT(numbers.size(), 100U);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i].first, i);
  // All that there was room for, but for what was not written yet.
  EXPECT_GT(std::filesystem::file_size(file_), kRoom / 2);
  EXPECT_EQ(run({"bag", "verify", "--repair", file_}).exit_code, 0);
  EXPECT_TRUE(numbers_in(*Recording::open({file_})).at("load_0") == numbers);
}

TEST_F(BagLoad, AWindowIsSavedAtASignalAgainAndAgain) {
  test::Process recorder = record({"--window", "1s", "--max-memory", "64MB"});
  ASSERT_TRUE(test::becomes_true(test::kStartLimit, [&] {
    return recorder.out().find("keeping the last 1 s") != std::string::npos;
  }));
  test::Process speaker = publish({2, 1000, 1000, 60.0, "reliable"});
  const auto saved = [this] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
      if (entry.path().extension() == ".mcap") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  };
  std::size_t full = 0;  // windows that were saved after they had filled
  for (int attempts = 0; full < 3 && attempts < 200; ++attempts) {
    const std::size_t before = saved().size();
    recorder.send(SIGUSR1);
    ASSERT_TRUE(test::becomes_true(test::kStartLimit, [&] {
      return saved().size() > before && Recording::open({saved().back()}).ok() &&
             Recording::open({saved().back()})->finished();
    })) << recorder.err();
    full += Recording::open({saved().back()})->statistics().message_count > 500 ? 1 : 0;
  }
  EXPECT_EQ(full, 3U) << recorder.err();
  speaker.send(SIGKILL);
  expect_end(recorder, SIGINT, 0);
  for (const auto& file : saved()) {
    const auto recording = Recording::open({file});
    ASSERT_TRUE(recording.ok());
    if (recording->statistics().message_count == 0) continue;  // before anybody spoke
    EXPECT_TRUE(recording->finished()) << file;
    const mcap::Statistics& statistics = recording->statistics();
    EXPECT_LE(statistics.message_end_time - statistics.message_start_time, 1'000'000'000U);
    for (const auto& [topic, numbers] : numbers_in(*recording)) {
      EXPECT_EQ(numbers.back().first - numbers.front().first, 2 * (numbers.size() - 1))
          << "samples are missing within the window";
    }
  }
}

}  // namespace
}  // namespace swiftlet
