// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// A ground station behind a radio that loses a packet in five, takes 300 ms, and at times is not
// there at all.
#include <fmt/format.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <random>
#include <sstream>

#include "swiftlet_msgs.h"
#include "tests/system/lossy_link.hpp"
#include "tests/system/tmux_screen.hpp"
#include "tests/system/virtual_network.hpp"

namespace swiftlet::test {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int kItems = 200;
constexpr Seconds kOutage{10.0};

class BadLink : public SpreadVehicleTest {
 protected:
  void SetUp() override {
    if (kSlowdown > 1) GTEST_SKIP() << "the sanitizers are too slow to fly in real time";
    for (const char* host : {"vehicle", "ground"}) {
      add_host(host);
      if (IsSkipped()) return;
    }
    LossyLink::Params params;
    params.loss = 0.2;
    params.delay = 300ms;
    try {
      link_.emplace(std::array<LossyLink::End, 2>{{{id_of("vehicle"), "10.7.0.1/24"},
                                                   {id_of("ground"), "10.7.0.2/24"}}},
                    params);
    } catch (const std::system_error& problem) {
      GTEST_SKIP() << "no tun interface can be made here: " << problem.what();
    }
    network_ = {"--network", "radio0", "--domain", "7", "--max-datagram", "1400"};
    const std::string file =
        write("system.yaml",
              fmt::format(
                  "scenario: {}\n"
                  "domain: {}\n"
                  "parameters:\n"
                  "  ground_link: {{domain: 7, network: {{interfaces: [radio0]}}, budget: 30000}}\n"
                  "hosts:\n"
                  "  vehicle:\n"
                  "    components: [sim, estimator, flight_controller, lidar_mapper, planner,\n"
                  "                 commander, ground_link]\n",
                  std::filesystem::relative(
                      SWIFTLET_SOURCE_DIR "/components/sim/scenarios/courtyard.yaml", folder())
                      .string(),
                  domain()));
    launch(file, {"vehicle"});
    becomes("ready", [](const nlohmann::json& now) { return now["ready"] == true; });
  }

  /// As the ground sees it, for as long as it takes to find the vehicle over such a link.
  template <class Condition>
  void becomes(const std::string& what, Condition condition) {
    nlohmann::json last;
    ASSERT_TRUE(becomes_true(
        Seconds(90.0),
        [&] {
          const Finished seen = on_ground({"status", "--json", "--patience", "30"}, Seconds(60.0));
          if (seen.exit_code != 0) return false;
          last = nlohmann::json::parse(seen.out);
          return condition(last);
        }))
        << "never " << what << ": " << last.dump(2) << logs();
  }

  /// `gcs <arguments>` on the ground, over the radio.
  Process start_on_ground(Arguments arguments) {
    arguments.insert(arguments.begin(), "gcs");
    arguments.insert(arguments.end(), network_.begin(), network_.end());
    return start_on("ground", arguments);
  }
  Finished on_ground(const Arguments& arguments, Seconds limit) {
    Process process = start_on_ground(arguments);
    const auto finished = process.wait(limit);
    EXPECT_TRUE(finished) << testing::PrintToString(arguments) << " did not end";
    return finished.value_or(Finished{-1, process.out(), process.err(), limit});
  }
  /// Beside the commander, where nothing is lost.
  Finished aboard(Arguments arguments) {
    arguments.insert(arguments.begin(), "gcs");
    return run_on("vehicle", arguments);
  }

  std::optional<LossyLink> link_;
};

/// 200 places that no other round has, clear of what the courtyard's map knows.
std::string some_mission(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> across(20, 45), along(20, 60);
  std::string text = "items:\n  - takeoff: 1.2\n";
  for (int i = 0; i < kItems - 2; ++i) {
    text += fmt::format("  - goto: {{x: {}, y: {}, z: 1.2}}\n", 0.1 * across(random),
                        0.1 * along(random));
  }
  return text + "  - land\n";
}

std::string items_in(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  const std::size_t items = text.str().find("items:");
  return items == std::string::npos ? "" : text.str().substr(items);
}

/// One after the other, each as often as it began.
std::vector<std::uint8_t> modes_in(const std::string& file) {
  std::vector<std::uint8_t> modes;
  const auto topics = read_topics(file);
  for (const mcap::Bytes& bytes : topics.at("vehicle/status")) {
    const auto status = from_cdr<swiftlet_msgs::msg::VehicleStatus>(bytes);
    if (!status.ok()) throw std::runtime_error(status.error().reason);
    if (modes.empty() || modes.back() != status->mode()) modes.push_back(status->mode());
  }
  return modes;
}

TEST_F(BadLink, AMissionArrivesWholeOrNotAtAll) {
  if (IsSkipped() || HasFatalFailure()) return;
  const unsigned rounds = full_tests() ? 100 : 3;
  std::string aboard_before;
  unsigned arrived = 0;
  std::vector<double> took;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> begins(1.0, 8.0);
  for (unsigned round = 1; round <= rounds; ++round) {
    SCOPED_TRACE(round);
    const std::string mission = some_mission(round);
    Process upload = start_on_ground({"mission", "upload", write("up.yaml", mission)});
    if (round % 3 == 0) {
      const Seconds begin(begins(random));
      if (!upload.wait(begin)) {
        link_->cut(true);
        (void)upload.wait(kOutage);
        link_->cut(false);
      }
    }
    const auto finished = upload.wait(Seconds(120.0));
    ASSERT_TRUE(finished) << "no end: " << upload.err();
    const Finished back = aboard({"mission", "download", path("back.yaml")});
    const std::string has = back.exit_code == 0 ? items_in(path("back.yaml")) : "";
    if (finished->exit_code == 0) {
      ++arrived;
      took.push_back(finished->duration.count());
      EXPECT_EQ(has, mission);
    } else {
      EXPECT_TRUE(has == aboard_before || has == mission) << "half a mission: " << has;
      std::printf("round %u: %s", round, finished->err.c_str());
    }
    aboard_before = has;
    if (HasFailure()) return;
  }
  std::sort(took.begin(), took.end());
  std::printf(
      "%u of %u missions of %d items arrived, the others not at all; %.1f s each (median), "
      "%.1f s at most; %llu packets carried, %llu lost\n",
      arrived, rounds, kItems, took.empty() ? 0.0 : took[took.size() / 2],
      took.empty() ? 0.0 : took.back(), static_cast<unsigned long long>(link_->carried()),
      static_cast<unsigned long long>(link_->lost()));
  // Nothing but an outage at the very end keeps one away.
  EXPECT_GE(10 * arrived, 9 * rounds);
}

/// Each command is one change of mode, however often it had to be sent.
TEST_F(BadLink, NoCommandIsCarriedOutTwice) {
  if (IsSkipped() || HasFatalFailure()) return;
  const int flights = full_tests() ? 20 : 3;
  const auto command = [&](Arguments arguments) {
    arguments.insert(arguments.end(), {"--patience", "60"});
    const Finished finished = on_ground(arguments, Seconds(90.0));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
  };
  Process recorder =
      start_on("vehicle", {"bag", "record", "-o", path("status.mcap"), "vehicle/status"});
  command({"arm"});
  command({"takeoff", "1.2"});
  becomes("hovering", [](const nlohmann::json& now) { return now["mode"] == "Hover"; });
  for (int i = 0; i < flights && !HasFailure(); ++i) {
    // Away and back, and stopped on the way.
    command({"goto", i % 2 == 0 ? "7" : "3", "3.5", "1.2"});
    command({"hover"});
  }
  command({"land"});
  becomes("landed", [](const nlohmann::json& now) {
    return now["mode"] == "Grounded" && now["armed"] == false;
  });
  expect_end(recorder, SIGINT, 0);
  const std::vector<std::uint8_t> modes = modes_in(path("status.mcap"));
  using namespace swiftlet_msgs::msg::VehicleStatus_Constants;
  const auto count = [&modes](std::uint8_t mode) {
    return std::count(modes.begin(), modes.end(), mode);
  };
  EXPECT_EQ(count(TAKEOFF), 1);
  EXPECT_EQ(count(INDOOR_NAVIGATION), flights);
  EXPECT_EQ(count(HOVER), flights + 1) << "after the take-off, and after each flight";
  EXPECT_EQ(count(LAND), 1);
  std::printf("%d commands, each carried out once; %llu packets carried, %llu lost\n",
              2 * flights + 3, static_cast<unsigned long long>(link_->carried()),
              static_cast<unsigned long long>(link_->lost()));
}

/// What is old is seen to be old, and what is back, too.
TEST_F(BadLink, TheScreenSaysWithinASecondThatNothingComes) {
  if (IsSkipped() || HasFatalFailure()) return;
  if (!TmuxScreen::available()) GTEST_SKIP() << "there is no tmux (package tmux)";
  std::string line =
      fmt::format("nsenter --target {} --net {} gcs", id_of("ground"), SWIFTLET_PROGRAM);
  for (const std::string& word : network_) line += " " + word;
  TmuxScreen screen(line, 80, 24, environment_, folder());
  ASSERT_TRUE(screen.shows("ready to arm", Seconds(60.0)));
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(becomes_true(Seconds(10.0),
                             [&] { return screen.text().find("LINK LOST") == std::string::npos; }));
    link_->cut(true);
    // What was on its way still comes; then a second, a picture, and a look at it.
    ASSERT_TRUE(screen.shows("LINK LOST", Seconds(0.3 + 1.0 + 0.5))) << round;
    const auto end = Clock::now() + kOutage;
    ASSERT_TRUE(becomes_true(kOutage * 2, [&] { return Clock::now() >= end; }));
    link_->cut(false);
  }
  screen.press("q");
  EXPECT_TRUE(screen.ended());
}

}  // namespace
}  // namespace swiftlet::test
