// SPDX-License-Identifier: Apache-2.0
#include "tool/map/map_from_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "core/files/grid_file.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tool/run_tool.hpp"

namespace deltamap::tool {
namespace {

/// A scan of 181 beams from inside a room of 4 × 3 m, whose lower left corner is the origin.
std::string scan_in_room(const Pose2& map_from_laser, const std::string& time) {
  std::string line = "FLASER 181";
  for (int i = 0; i < 181; ++i) {
    const double bearing = map_from_laser.theta + (i - 90) * std::numbers::pi / 180.0;
    const double dx = std::cos(bearing);
    const double dy = std::sin(bearing);
    const double to_x = dx > 0.0 ? (4.0 - map_from_laser.x) / dx : dx < 0.0 ? -map_from_laser.x / dx : 1e9;
    const double to_y = dy > 0.0 ? (3.0 - map_from_laser.y) / dy : dy < 0.0 ? -map_from_laser.y / dy : 1e9;
    char text[32];
    (void)std::snprintf(text, sizeof text, " %.3f", i % 20 == 7 ? 8.191 : std::min(to_x, to_y) + 0.02);
    line += text;
  }
  char poses[128];
  (void)std::snprintf(poses, sizeof poses, " %.6f %.6f %.6f 50 60 0.7 ", map_from_laser.x, map_from_laser.y,
                      map_from_laser.theta);
  return line + poses + time + " host 0\n";
}

std::string room_log() {
  std::string log;
  for (int i = 0; i < 24; ++i)
    log += scan_in_room({1.0 + 0.08 * i, 1.5, i * std::numbers::pi / 12.0}, std::to_string(i));
  return log;
}

TEST(MapFromPoses, DrawsTheWallsOfARoomWhereTheyAre) {
  const test::TemporaryFolder folder;
  const MapFromPoses made = map_from_poses(folder.write("room.log", room_log()), {.resolution_m = 0.1});
  const GridGeometry& geometry = made.grid.geometry();
  const auto state = [&](double x, double y) { return made.grid.at(geometry.cell_at({x, y})); };
  EXPECT_EQ(made.scans, 24u);
  for (double x = 0.15; x < 4.0; x += 0.1) {
    EXPECT_EQ(state(x, 3.05), CellState::kOccupied) << x;
    EXPECT_EQ(state(x, -0.05), CellState::kOccupied) << x;
    EXPECT_EQ(state(x, 1.5), CellState::kFree) << x;
    EXPECT_EQ(state(x, 3.35), CellState::kUnknown) << x;
  }
  for (double y = 0.15; y < 3.0; y += 0.1) {
    EXPECT_EQ(state(4.05, y), CellState::kOccupied) << y;
    EXPECT_EQ(state(-0.05, y), CellState::kOccupied) << y;
  }
  EXPECT_LT(geometry.width, 60);  // no return at 8.191 m does not blow it up
  EXPECT_NEAR(std::remainder(geometry.origin.x(), 0.1), 0.0, 1e-9);
}

TEST(MapFromPoses, WritesAMapThroughTheTool) {
  const test::TemporaryFolder folder;
  const std::string log = folder.write("room.log", room_log());
  const std::string yaml = (folder.path() / "room.yaml").string();
  const char* arguments[] = {"deltamap", "map", "from-poses", log.c_str(), yaml.c_str(), "--resolution", "0.05"};
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_tool(7, arguments), 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("from 24 scans"), std::string::npos);
  EXPECT_EQ(read_grid(yaml), map_from_poses(log, {}).grid);
}

TEST(MapFromPoses, NeedsNoTimesAndReadsALogUpToItsCut) {
  const test::TemporaryFolder folder;
  const std::string log = room_log();
  const OccupancyGrid expected = map_from_poses(folder.write("room.log", log), {}).grid;
  const auto with_ends = [&](const std::string& end) {
    std::string changed;
    std::istringstream lines{log};
    for (std::string line; std::getline(lines, line);) {
      line.resize(line.rfind(' ', line.rfind(" host") - 1));  // up to the poses
      changed += line + end + "\n";
    }
    return changed;
  };
  for (const char* end : {"", " nohost 3.5", " 1.13486e+09 nohost 0", " 1.13486e+09"}) {
    const std::string changed = with_ends(end);
    EXPECT_EQ(map_from_poses(folder.write("other.log", changed), {}).grid, expected) << end;
    const std::string half = changed.substr(0, changed.rfind("FLASER"));
    const MapFromPoses cut = map_from_poses(folder.write("cut.log", half + "FLASER 181 1.5 2.5"), {});
    EXPECT_EQ(cut.grid, map_from_poses(folder.write("half.log", half), {}).grid) << end;
    ASSERT_TRUE(cut.survey.cut) << end;
    EXPECT_NE(cut.survey.cut->find("cut.log:24: "), std::string::npos) << *cut.survey.cut;
  }
  // A pose that the cut has shortened is no pose.
  const std::string bare = with_ends("");
  EXPECT_TRUE(map_from_poses(folder.write("pose.log", bare.substr(0, bare.size() - 4)), {}).survey.cut);
}

TEST(MapFromPoses, TellsOfPosesThatJumpAndOfTheClock) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i < 24; ++i)
    log += scan_in_room({1.0 + 0.08 * i + (i >= 12 ? 7.0 : 0.0), 1.5, 0.1 * i}, std::to_string(i < 12 ? 500 + i : i));
  const std::string in = folder.write("room.log", log + "RAWLASER1 0 -1.57 3.14 3.14 8 0.01 0 2 1 1 0 24 host 0\n");
  const std::string yaml = (folder.path() / "room.yaml").string();
  for (const std::vector<const char*>& more : {std::vector<const char*>{}, {"--json"}}) {
    std::vector<const char*> arguments{"deltamap", "map", "from-poses", in.c_str(), yaml.c_str()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_tool(static_cast<int>(arguments.size()), arguments.data()), 0);
    const std::string told = testing::internal::GetCapturedStdout();
    for (const char* part :
         {"the laser's pose jumps 1 time (the first in line 13)",
          "the log's clock was set back 1 time (the first in line 13)", "1 scan without a pose left out"}) {
      EXPECT_NE(told.find(part), std::string::npos) << told;
    }
  }
}

TEST(MapFromPoses, ReadsLaserPosesInDegreesWhateverTheRobotsAre) {
  const test::TemporaryFolder folder;
  std::string log;
  std::string in_degrees;
  for (int i = 0; i < 24; ++i) {
    const Pose2 pose{1.0 + 0.05 * i, 1.5 + 0.042 * i, 0.7};
    log += scan_in_room(pose, std::to_string(i));
    std::string line = scan_in_room(pose, std::to_string(i));
    in_degrees += line.replace(line.find(" 0.700000 "), 10, " 40.107046 ");
  }
  const MapFromPoses made = map_from_poses(folder.write("degrees.log", in_degrees), {});
  EXPECT_EQ(made.survey.headings, drivers::carmen::HeadingUnit::kDegree);
  EXPECT_EQ(made.grid, map_from_poses(folder.write("room.log", log), {}).grid);
}

TEST(MapFromPoses, LeavesOutWhatIsNoReturn) {
  const test::TemporaryFolder folder;
  std::string log = room_log();
  int count = 0;  // a cluster of codes in place of one
  for (std::size_t at; (at = log.find("8.191")) != std::string::npos; ++count) {
    log.replace(at, 5, "7." + std::to_string(105 + count % 12).substr(1));
  }
  const std::string file = folder.write("room.log", log);
  const MapFromPoses made = map_from_poses(file, {});
  EXPECT_LT(made.grid.geometry().width, 120);
  EXPECT_EQ(made.survey.no_return_m, 7.05);
  EXPECT_GT(map_from_poses(file, {.no_return_m = 0.0}).grid.geometry().width, 200) << "spokes";
  EXPECT_LT(map_from_poses(file, {.no_return_m = 2.0}).beams, made.beams);
  const std::string yaml = (folder.path() / "room.yaml").string();
  const char* arguments[] = {"deltamap", "map", "from-poses", file.c_str(), yaml.c_str(), "--no-return", "7"};
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_tool(7, arguments), 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("no return: 7 m and more, as given"), std::string::npos);
  EXPECT_EQ(read_grid(yaml), made.grid);
}

TEST(MapFromPoses, SaysWhyItCannot) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& log) -> std::string {
    try {
      (void)map_from_poses(folder.write("bad.log", log), {});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("").find("bad.log: line 1: the file is empty"), std::string::npos);
  EXPECT_NE(refusal("RAWLASER1 0 -1.57 3.14 1.57 81 0.01 0 3 1 1 1 0 10 host 0\n")
                .find("bad.log: no scan carries a laser pose"),
            std::string::npos);
  EXPECT_NE(refusal("FLASER 2 0 0 0 0 0 0 0 0 1 h 1\n").find("bad.log: no scan has a valid range"), std::string::npos);
  EXPECT_NE(refusal("FLASER 2 1.5 2 0 0 0 0 0 0 1 h 1\nFLASER 2 1.5 2.5 9e7 0 0 0 0 0 2 h 1\n")
                .find("bad.log: the map would need"),
            std::string::npos);
  const std::string log = folder.write("room.log", room_log());
  const char* no_yaml[] = {"deltamap", "map", "from-poses", log.c_str(), "out.pgm"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_tool(5, no_yaml), 2);
  (void)testing::internal::GetCapturedStderr();
}

}  // namespace
}  // namespace deltamap::tool
