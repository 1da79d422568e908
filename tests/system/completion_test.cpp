// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// What the shell is told, by the shell itself.
#include "tests/system/system_test.hpp"

namespace swiftlet::test {
namespace {

class Completion : public SystemTest {
 protected:
  /// What bash would offer for "swiftlet WORDS...", the last of which is begun.
  std::string offered(const Arguments& words) {
    std::string line = "source '" SWIFTLET_SOURCE_DIR
                       "/components/cli/swiftlet.bash'\n"
                       "COMP_WORDS=('" SWIFTLET_PROGRAM "'";
    for (const std::string& word : words) line += " '" + word + "'";
    line +=
        ")\nCOMP_CWORD=" + std::to_string(words.size()) + "\n_swiftlet\necho \"${COMPREPLY[*]}\"";
    Process bash = start_command({"bash", "-c", line});
    const auto end = bash.wait(Seconds(20.0) * kSlowdown);
    EXPECT_TRUE(end && end->exit_code == 0) << bash.err();
    return bash.out();
  }
};

TEST_F(Completion, VerbsOptionsAndComponents) {
  EXPECT_EQ(offered({"gcs", "take"}), "takeoff\n");
  EXPECT_EQ(offered({"gcs", "m"}), "manual map mission mode\n");
  EXPECT_EQ(offered({"gcs", "mode", "ma"}), "manual\n");
  EXPECT_EQ(offered({"gcs", "waypoint", ""}), "add list move remove\n");
  EXPECT_EQ(offered({"gcs", "cloud", "save", "a.ply", "--se"}), "--seconds --see-all\n");
  EXPECT_EQ(offered({"gcs", "param", "dump", "plan"}), "planner\n");
  EXPECT_EQ(offered({"bag", "re"}), "record\n");
  EXPECT_EQ(offered({"--log", "debug", "doc"}), "doctor\n") << "'debug' is a value, no verb";
  EXPECT_EQ(offered({"fly", "--rea"}), "--real-time\n");
  EXPECT_EQ(offered({"run", "planner", "estim"}), "estimator\n");
  EXPECT_EQ(offered({"replay", "f.mcap", "--into", "lidar_m"}), "lidar_mapper\n");
  EXPECT_EQ(offered({"fly", "--seed", ""}), "\n") << "a number";
  EXPECT_EQ(offered({"xylophone", "ta"}), "\n");
}

}  // namespace
}  // namespace swiftlet::test
