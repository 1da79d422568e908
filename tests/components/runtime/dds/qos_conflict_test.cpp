// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Two processes whose files do not fit each other: both say so, and soon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "tests/system/process.hpp"

namespace swiftlet::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Seconds kLimit(20.0);
/// What the project promises; the sanitizers get more.
constexpr double kReportWithin_s = 1.0 * kSlowdown;

/// One topic, what its writer offers and its reader asks for, and what is to be said of it.
struct Case {
  const char* topic;
  const char* offered;
  const char* requested;
  const char* said;
};

const Case kConflicts[] = {
    {"reliability", "<reliability><kind>BEST_EFFORT</kind></reliability>",
     "<reliability><kind>RELIABLE</kind></reliability>",
     "reliability: offered best effort, requested reliable"},
    {"durability", "<durability><kind>VOLATILE</kind></durability>",
     "<durability><kind>TRANSIENT_LOCAL</kind></durability>",
     "durability: offered volatile, requested transient local"},
    {"deadline", "<deadline><period><sec>2</sec></period></deadline>",
     "<deadline><period><sec>1</sec></period></deadline>", "deadline: offered 2 s, requested 1 s"},
    {"liveliness", "<liveliness><kind>AUTOMATIC</kind></liveliness>",
     "<liveliness><kind>MANUAL_BY_TOPIC</kind></liveliness>",
     "liveliness: offered automatic, requested manual by topic"},
    {"lease", "<liveliness><lease_duration><sec>9</sec></lease_duration></liveliness>",
     "<liveliness><lease_duration><sec>3</sec></lease_duration></liveliness>",
     "liveliness lease: offered 9 s, requested 3 s"},
    {"ownership", "<ownership><kind>EXCLUSIVE</kind></ownership>",
     "<ownership><kind>SHARED</kind></ownership>",
     "ownership: offered exclusive, requested shared"},
    {"budget", "<latencyBudget><duration><sec>2</sec></duration></latencyBudget>",
     "<latencyBudget><duration><sec>1</sec></duration></latencyBudget>",
     "latency budget: offered 2 s, requested 1 s"},
    {"partition", "<partition><names><name>left</name></names></partition>",
     "<partition><names><name>right</name></names></partition>",
     "partition: offered 'left', requested 'right'"},
};

/// Policies that are not the default ones, and fit.
const Case kFitting[] = {
    {"fine_deadline", "<deadline><period><sec>1</sec></period></deadline>",
     "<deadline><period><sec>2</sec></period></deadline>", ""},
    {"fine_ownership", "<ownership><kind>EXCLUSIVE</kind></ownership>",
     "<ownership><kind>EXCLUSIVE</kind></ownership>", ""},
    {"fine_partition", "<partition><names><name>uav*</name></names></partition>",
     "<partition><names><name>uav1</name></names></partition>", ""},
};

class QosConflictTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "qos_conflict_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  template <std::size_t N>
  Process start(const std::string& role, const Case (&cases)[N]) {
    const std::string element = role == "writer" ? "data_writer" : "data_reader";
    const std::string file = folder_ / (role + ".xml");
    std::vector<std::string> command{SWIFTLET_QOS_PEER, "79", role, file};
    std::ofstream xml(file);
    xml << "<dds><profiles>\n";
    for (const Case& c : cases) {
      xml << "<" << element << " profile_name=\"" << c.topic << "\"><qos>"
          << (role == "writer" ? c.offered : c.requested) << "</qos></" << element << ">\n";
      command.push_back(c.topic);
    }
    xml << "</profiles></dds>\n";
    xml.close();
    return Process(command, {}, folder_ / role);
  }

  /// Lines that begin with `what`: the moments in seconds, and the texts.
  static std::vector<std::pair<double, std::string>> said(const Process& process,
                                                          const std::string& what) {
    std::vector<std::pair<double, std::string>> result;
    std::istringstream lines(process.out());
    std::string line, word, text;
    std::int64_t ns = 0;
    while (std::getline(lines, line)) {
      std::istringstream fields(line);
      fields >> word >> ns >> std::ws;
      std::getline(fields, text);
      if (word == what) result.emplace_back(double(ns) / 1e9, text);
    }
    return result;
  }

  fs::path folder_;
};

TEST_F(QosConflictTest, BothEndsNameEveryPolicyWithinASecond) {
  Process writer = start("writer", kConflicts);
  ASSERT_TRUE(becomes_true(kLimit, [&] { return !said(writer, "made").empty(); })) << writer.err();
  Process reader = start("reader", kConflicts);
  const auto all_known = [&] {
    return said(writer, "conflict").size() == std::size(kConflicts) &&
           said(reader, "conflict").size() == std::size(kConflicts);
  };
  EXPECT_TRUE(becomes_true(kLimit, all_known)) << writer.out() << reader.out() << reader.err();
  ASSERT_FALSE(said(reader, "made").empty());
  const double begin_s = said(reader, "made").front().first;
  for (const Process* end : {&writer, &reader}) {
    const auto conflicts = said(*end, "conflict");
    for (const Case& c : kConflicts) {
      const auto found = std::find_if(conflicts.begin(), conflicts.end(), [&](const auto& entry) {
        return entry.second.find("'rt/" + std::string(c.topic) + "'") != std::string::npos;
      });
      ASSERT_NE(found, conflicts.end()) << c.topic;
      EXPECT_THAT(found->second,
                  AllOf(HasSubstr(c.said), HasSubstr("'offering'"), HasSubstr("'process_w'"),
                        HasSubstr("'asking'"), HasSubstr("'process_r'")));
      EXPECT_LT(found->first - begin_s, kReportWithin_s) << c.topic;
    }
  }
}

TEST_F(QosConflictTest, PoliciesThatFitLetSamplesThroughAndAreNotReported) {
  Process writer = start("writer", kFitting);
  Process reader = start("reader", kFitting);
  EXPECT_TRUE(
      becomes_true(kLimit, [&] { return said(reader, "sample").size() == std::size(kFitting); }))
      << reader.out() << reader.err();
  EXPECT_TRUE(said(reader, "conflict").empty()) << reader.out();
  EXPECT_TRUE(said(writer, "conflict").empty()) << writer.out();
}

}  // namespace
}  // namespace swiftlet::test
