// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// The report of a flight, opened in a browser.
#include <fstream>
#include <iterator>

#include "components/bag/topic_file.hpp"
#include "components/topics.hpp"
#include "tests/system/recorded.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr Seconds kBrowserLimit{60.0};

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

/// Lines in plots, in the way that Chromium writes them down, of some hundred points or more.
std::size_t long_lines_of(const std::string& dom) {
  const std::string begin = "<path d=\"M";
  std::size_t count = 0;
  for (std::size_t at = 0; (at = dom.find(begin, at)) != std::string::npos; ++at) {
    const std::size_t end = dom.find('"', at + begin.size());
    const bool is_line = dom.compare(end, 14, "\" class=\"line ") == 0;
    if (is_line && end - at > 2000) ++count;
  }
  return count;
}

/// The page without the name of SVG's elements, which is an address but nothing that is loaded.
std::string without_names(std::string page) {
  const std::string name = "http://www.w3.org/2000/svg";
  for (std::size_t at = 0; (at = page.find(name)) != std::string::npos;)
    page.erase(at, name.size());
  return page;
}

class FlightReportTest : public SystemTest {
 protected:
  /// What is on the page when its script has run; skips the test where there is no Chromium.
  std::string opened(const std::string& page) {
    Process browser = start_command(
        {"chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
         "--user-data-dir=" + path("chromium"), "--window-size=1280,900",
         "--virtual-time-budget=5000", "--dump-dom", "file://" + page});
    const auto finished = browser.wait(kBrowserLimit);
    if (finished && finished->exit_code == 127) return "";
    EXPECT_TRUE(finished) << "Chromium does not end: " << browser.err();
    EXPECT_THAT(browser.out(), HasSubstr("</html>")) << browser.err();
    return browser.out();
  }
};

TEST_F(FlightReportTest, OfTheOfficeIsDrawnByABrowserWithoutNetwork) {
  ASSERT_EQ(run({"--log", "warning", "fly", office(), "--record", path("office.mcap")}).exit_code,
            0);
  const Finished reported = run({"report", path("office.mcap"), "--out", path("office.html")});
  ASSERT_EQ(reported.exit_code, 0) << reported.err;
  EXPECT_THAT(reported.out, HasSubstr("Landed"));
  EXPECT_EQ(reported.err, "");

  const std::string page = content_of(path("office.html"));
  EXPECT_LT(page.size(), 5'000'000U);
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  const std::string rest = without_names(page);
  EXPECT_THAT(rest, Not(HasSubstr("http:")));
  EXPECT_THAT(rest, Not(HasSubstr("https:")));
  EXPECT_EQ(count_of(rest, " src="), 0U);

  const std::string dom = opened(path("office.html"));
  if (dom.empty()) GTEST_SKIP() << "chromium is absent: apt install chromium";
  EXPECT_THAT(dom, HasSubstr("data-drawn=\""));
  EXPECT_THAT(dom, Not(HasSubstr("data-errors")));
  // The ribbon of modes, the map, and a plot for each thing that a simulated flight records.
  EXPECT_GE(count_of(dom, "<figure data-plot="), 14U);
  EXPECT_EQ(count_of(dom, "<figure data-plot="), count_of(dom, "class=\"frame\"></rect>"));
  EXPECT_THAT(dom, HasSubstr("href=\"data:image/png;base64,"));
  EXPECT_THAT(dom, HasSubstr("Indoor Navigation</text>"));
  EXPECT_THAT(dom, HasSubstr("class=\"here\""));
  // Lines with data, not only axes.
  EXPECT_GE(long_lines_of(dom), 20U);
}

TEST_F(FlightReportTest, MarkupInAReasonIsNotRun) {
  auto writer = mcap::Writer::open(path("evil.mcap"), {});
  ASSERT_TRUE(writer.ok());
  TopicWriter<swiftlet_msgs::msg::VehicleStatus> status;
  ASSERT_TRUE(status.open(*writer, topic::vehicle_status.name).ok());
  swiftlet_msgs::msg::VehicleStatus message;
  ASSERT_TRUE(status.write(*writer, Time{}, message).ok());
  message.mode(swiftlet_msgs::msg::VehicleStatus_Constants::TAKEOFF);
  message.reason("</td></script><script>document.title='run'</script><b id=\"bold\">");
  ASSERT_TRUE(status.write(*writer, Time{} + std::chrono::seconds(1), message).ok());
  ASSERT_TRUE(writer->close().ok());
  ASSERT_EQ(run({"report", path("evil.mcap")}).exit_code, 0);  // beside the recording

  const std::string dom = opened(path("evil.html"));
  if (dom.empty()) GTEST_SKIP() << "chromium is absent: apt install chromium";
  EXPECT_THAT(dom, HasSubstr("<title>Flight report"));
  EXPECT_THAT(dom, Not(HasSubstr("<b id=\"bold\"")));
  EXPECT_THAT(dom, HasSubstr("&lt;script&gt;document.title='run'&lt;/script&gt;"));
  EXPECT_THAT(dom, Not(HasSubstr("data-errors")));
}

TEST_F(FlightReportTest, WhatCannotBeReportedIsSaidAndLeavesNothing) {
  const std::string page = path("page.html");
  const auto refused = [&](const std::string& recording, const std::string& why) {
    const Finished finished = run({"report", recording, "--out", page});
    EXPECT_EQ(finished.exit_code, 2) << finished.out;
    EXPECT_THAT(finished.err, HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(page));
    EXPECT_FALSE(std::filesystem::exists(page + ".partial"));
  };
  refused(path("absent.mcap"), "absent.mcap");
  refused(write("text.mcap", "this is no recording"), "text.mcap");
  auto writer = mcap::Writer::open(path("empty.mcap"), {});
  ASSERT_TRUE(writer.ok() && writer->close().ok());
  refused(path("empty.mcap"), "empty.mcap: holds no message");

  write_recording(path("walk.mcap"));
  const Finished nowhere = run({"report", path("walk.mcap"), "-o", path("no/such/page.html")});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("there is no folder"));
  const Finished itself = run({"report", path("walk.mcap"), "-o", path("walk.mcap")});
  EXPECT_EQ(itself.exit_code, 2);
  EXPECT_THAT(itself.err, HasSubstr("is the recording itself"));
  EXPECT_EQ(run({"report", path("walk.mcap"), "--out", page}).exit_code, 0);
}

}  // namespace
}  // namespace swiftlet::test
