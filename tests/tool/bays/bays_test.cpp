// SPDX-License-Identifier: Apache-2.0
// `deltamap bays` on a recorded drive past a box that appears.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/files/grid_file.hpp"
#include "daemon/site/bays_file.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tool/ctl/bays_table.hpp"
#include "tool/import_carmen.hpp"

namespace deltamap::tool {
namespace {

using test::run_deltamap;
using test::ToolRun;

class BaysCommand : public testing::Test {
 protected:
  BaysCommand() {
    test::write_drive(folder.path() / "drive.log", 30.0);
    (void)import_carmen(folder.path() / "drive.log", recording, std::nullopt);
    write_grid(test::small_room(false), map);
    std::ofstream{bays} << "bays:\n"
                           "  - {id: box, polygon: [[4.75, 4.75], [5.85, 4.75], [5.85, 5.65], [4.75, 5.65]]}\n"
                           "  - {id: floor, polygon: [[5.2, 2.6], [6.4, 2.6], [6.4, 3.8], [5.2, 3.8]]}\n";
  }
  [[nodiscard]] ToolRun told(std::vector<std::string> more) const {
    const Pose2 pose = test::pose_on_drive(0.0);
    std::vector<std::string> words{
        "bays",
        map,
        recording,
        "--bays",
        bays,
        "--set",
        "localization.particles.min=200",
        "--set",
        "localization.particles.max=200",
        "--initial-pose",
        std::to_string(pose.x) + "," + std::to_string(pose.y) + "," + std::to_string(degrees(pose.theta))};
    words.insert(words.end(), more.begin(), more.end());
    return run_deltamap(words);
  }

  test::TemporaryFolder folder;
  std::string recording = folder.path() / "drive.pcapng";
  std::string map = folder.path() / "room.yaml";
  std::string bays = folder.path() / "bays.yaml";
};

TEST_F(BaysCommand, TellsWhatARecordingSawAndTellsItAgain) {
  const ToolRun run = told({"--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  std::string states;
  std::istringstream lines{run.output};
  for (std::string line; std::getline(lines, line);) {
    const auto event = nlohmann::json::parse(line);
    if (event["bay"] == "box") states += event["state"].get<std::string>() + " ";
    EXPECT_LE(event["last_seen"], event["time"]);
    EXPECT_TRUE(event["bay"] == "box" || event["state"] == "empty") << line;
  }
  EXPECT_EQ(states, "empty full ") << run.output;
  EXPECT_EQ(told({"--json"}).output, run.output);
  const ToolRun table = told({});
  EXPECT_NE(table.output.find("box           full      was empty"), std::string::npos) << table.output;
  EXPECT_NE(table.output.find("2 bays: 1 full, 1 empty\n"), std::string::npos) << table.output;
}

TEST_F(BaysCommand, RefusesBaysThatCannotBeBeforeItReads) {
  std::ofstream{bays} << "bays:\n  - {id: off, polygon: [[1, 1], [99, 1], [99, 9]]}\n";
  const ToolRun run = told({});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("bays.yaml: line 2: bay 'off' lies off the map"), std::string::npos) << run.errors;
  EXPECT_EQ(run_deltamap({"bays", map, recording}).exit_code, 1) << "no bays are named";
  EXPECT_EQ(run_deltamap({"bays"}).exit_code, 2);
}

TEST_F(BaysCommand, ImportsATableAndRefusesWhatCannotBe) {
  const std::string table = folder.path() / "site.csv";
  const std::string out = folder.path() / "new.yaml";
  std::ofstream{table} << "id,x_m,y_m\nA,3,3\nB,5.4,3\n";
  const ToolRun run = run_deltamap({"bays", "import", table, "--out", out, "--size", "2.4x2.4", "--map", map});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output, out + ": 2 bays\n");
  EXPECT_EQ(daemon::read_bays(out).size(), 2u);
  const ToolRun overlapping = run_deltamap({"bays", "import", table, "--out", out, "--size", "3x3"});
  EXPECT_EQ(overlapping.exit_code, 1);
  EXPECT_NE(overlapping.errors.find("bay 'B' overlaps bay 'A' by 1.8 m²"), std::string::npos) << overlapping.errors;
  const ToolRun off = run_deltamap({"bays", "import", table, "--out", out, "--size", "9x1", "--map", map});
  EXPECT_EQ(off.exit_code, 1) << "and what was there stays";
  EXPECT_EQ(daemon::read_bays(out).size(), 2u);
}

TEST_F(BaysCommand, AnImportKeepsTheListThatItReplaces) {
  const std::string table = folder.path() / "site.csv";
  std::ofstream{table} << "id,x_m,y_m\nA,3,3\n";
  const std::string before = test::content_of(bays);
  const std::vector<std::string> import{"bays", "import", table, "--out", bays, "--size", "2.4x2.4"};
  const ToolRun run = run_deltamap(import);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const std::string words = bays + ": 1 bay; what stood there is kept in ";
  ASSERT_TRUE(run.output.starts_with(words)) << run.output;
  const std::string kept = run.output.substr(words.size(), run.output.size() - words.size() - 1);
  EXPECT_EQ(test::content_of(kept), before);
  EXPECT_EQ(daemon::read_bays(bays).size(), 1u);
  EXPECT_EQ(run_deltamap(import).output, bays + ": 1 bay\n") << "the same again loses nothing";
}

TEST(BaysTable, TellsAgesAndCounts) {
  const std::string list =
      R"({"ok":true,"time":1764000100.0,"bays":[{"bay":"B4","name":"Row B","state":"full","share":0.93,"confidence":0.8,)"
      R"("last_seen":1764000060.0,"age_s":40.0,"since":1764000000.0,"things":[12,13],"polygon_m":[]},)"
      R"({"bay":"B5","state":"unknown","share":null,"confidence":0.0,"last_seen":null,"age_s":null,"since":null,)"
      R"("things":[],"polygon_m":[]}]})";
  EXPECT_EQ(bays_table(list),
            "bay           state     share  conf      seen  since                 what\n"
            "B4            full       0.93  0.80      40 s  2025-11-24T16:00:00Z  Row B, thing 12, thing 13\n"
            "B5            unknown       -  0.00     never  -\n"
            "2 bays: 1 full, 1 unknown\n");
  EXPECT_EQ(bays_table(R"({"ok":true,"time":1764000100.0,"bays":[]})"),
            "no bay: the file that 'bays.file' of the settings names lists them\n");
}

}  // namespace
}  // namespace deltamap::tool
