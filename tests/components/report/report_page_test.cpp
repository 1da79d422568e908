// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/report/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/components/bag/temporary_folder.hpp"
#include "tests/components/report/made_up_recording.hpp"

namespace swiftlet {
namespace {

namespace mode = swiftlet_msgs::msg::VehicleStatus_Constants;
using testing::HasSubstr;
using testing::Not;

/// The data that the page's script draws.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

std::vector<std::string> titles_of(const nlohmann::json& data) {
  std::vector<std::string> titles;
  for (const auto& plot : data["plots"]) titles.push_back(plot["title"]);
  return titles;
}

class ReportPage : public testing::Test {
 protected:
  TemporaryFolder folder_;
  MadeUpRecording made_up_{folder_ / "flight.mcap"};
};

TEST_F(ReportPage, OfOdometryAloneHasItsPlotsAndSaysWhatIsMissing) {
  for (int i = 0; i < 500; ++i) {
    made_up_.add("odometry", 0.01 * i, odometry_at(0.01 * i, {0.02 * i, 1, 1}, {2, 0, 0}));
  }
  const std::string page = report_page(told(made_up_.close()));
  EXPECT_THAT(titles_of(data_of(page)),
              testing::ElementsAre("x", "y", "z", "speed", "roll and pitch", "yaw"));
  EXPECT_THAT(page, HasSubstr("2.00 m/s"));
  EXPECT_THAT(page, HasSubstr("vehicle/status is not in the recording"));
  EXPECT_THAT(page, HasSubstr("it needs battery"));
  EXPECT_THAT(page, HasSubstr("setpoint is not in the recording"));
  EXPECT_THAT(page, HasSubstr("has no ledger of losses"));
  EXPECT_THAT(page, HasSubstr("map is not in the recording"));
}

TEST_F(ReportPage, WithoutOdometryDrawsNoEmptyPlots) {
  made_up_.add("battery", 0.0, sensor_msgs::msg::BatteryState());
  const std::string page = report_page(told(made_up_.close()));
  for (const std::string& title : titles_of(data_of(page))) EXPECT_THAT(title, Not("x"));
  EXPECT_THAT(page, HasSubstr("odometry is not in the recording"));
  EXPECT_TRUE(data_of(page)["map"].is_null());
}

TEST_F(ReportPage, MarkupInARecordingIsText) {
  const std::string evil = "</script><script>document.title='x'</script><img src=x onerror=y>";
  made_up_.add("vehicle/status", 0.0, status_at(0.0, mode::GROUNDED));
  made_up_.add("vehicle/status", 1.0, status_at(1.0, mode::TAKEOFF, evil));
  made_up_.add("odometry", 0.5, odometry_at(0.5, {0, 0, 1}));
  made_up_.add("odd/" + evil, 1.0, sensor_msgs::msg::Range());
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.name(evil);
  for (const char* key : {"nis_mean", "nis_95_percent_low", "nis_95_percent_high"}) {
    status.values().emplace_back();
    status.values().back().key(key);
    status.values().back().value("1.0");
  }
  diagnostic_msgs::msg::DiagnosticArray array;
  array.status({status});
  made_up_.add("diagnostics", 0.2, array);  // its name becomes the title of a plot
  swiftlet_msgs::msg::GuardStatus guard;
  guard.acting(true);
  guard.reason(evil);
  made_up_.add("guard/status", 0.7, guard);  // its reason becomes a label on the map
  made_up_.add(mcap::Metadata{"swiftlet_run", {{evil, evil}, {"parameters", evil}}});
  const std::string page = report_page(told(made_up_.close()));

  // Two scripts of our own, and no other element that would run one.
  std::size_t scripts = 0;
  for (std::size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) ++scripts;
  EXPECT_EQ(scripts, 2U);
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x onerror=y&gt;"));
  EXPECT_EQ(data_of(page)["plots"].back()["title"], evil + ": nis_mean");
}

TEST_F(ReportPage, LoadsNothingFromOutside) {
  made_up_.add("odometry", 0.0, odometry_at(0.0, {0, 0, 1}));
  const std::string page = report_page(told(made_up_.close()));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  // The name of SVG's elements is an address, but nothing that is loaded.
  const std::string rest =
      std::regex_replace(page, std::regex("'http://www\\.w3\\.org/2000/svg'"), "''");
  EXPECT_THAT(rest, Not(HasSubstr("http:")));
  EXPECT_THAT(rest, Not(HasSubstr("https:")));
  EXPECT_FALSE(std::regex_search(rest, std::regex("\\ssrc=")));
  EXPECT_FALSE(std::regex_search(rest, std::regex("\\shref=\"[^#]")));
  EXPECT_THAT(rest, Not(HasSubstr("url(")));
  EXPECT_THAT(rest, Not(HasSubstr("@import")));
}

TEST_F(ReportPage, IsBoundedHoweverLongTheFlightIs) {
  constexpr double kStep = 0.05;
  for (int i = 0; i < 72'000; ++i) {  // an hour
    const double time = kStep * i;
    const Eigen::Vector3d position(50.0 * std::cos(0.01 * time), 50.0 * std::sin(0.013 * time),
                                   2.0 + std::sin(i));
    made_up_.add("odometry", time, odometry_at(time, position, {std::sin(i), std::cos(i), 0}));
    made_up_.add("setpoint", time, setpoint_at(time, position));
  }
  const std::string page = report_page(told(made_up_.close()));
  EXPECT_LT(page.size(), 3'000'000U);
  const auto data = data_of(page);
  ASSERT_FALSE(data["plots"].empty());
  for (const auto& plot : data["plots"]) {
    for (const auto& series : plot["series"]) {
      EXPECT_LE(series["t"].size(), 2U * ThinnedCurve::kColumns + 2U) << plot["title"];
    }
  }
}

TEST_F(ReportPage, IsNeverHalfWritten) {
  made_up_.add("odometry", 0.0, odometry_at(0.0, {0, 0, 1}));
  const FlightStory story = told(made_up_.close());
  const Status failed = write_report(story, folder_ / "nowhere/report.html");
  ASSERT_FALSE(failed.ok());
  EXPECT_THAT(failed.error().reason, HasSubstr("nowhere/report.html: cannot be written"));
  ASSERT_TRUE(write_report(story, folder_ / "report.html").ok());
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_NE(entry.path().extension(), ".partial");
    ++files;
  }
  EXPECT_EQ(files, 2U);  // the recording and the report
}

}  // namespace
}  // namespace swiftlet
