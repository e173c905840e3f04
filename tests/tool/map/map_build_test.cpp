// SPDX-License-Identifier: Apache-2.0
// `deltamap map build` on recordings of drives through a drawn hall.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/files/grid_file.hpp"
#include "mapping/registration/transformed_grid.hpp"
#include "simulation/score/trajectory_score.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/carmen_survey_log.hpp"
#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::tool {
namespace {

using test::run_deltamap;

class MapBuild : public testing::Test {
 protected:
  /// A recording of a drive along the way; answers its name.
  std::string recorded(const std::string& name, const OccupancyGrid& world, const std::vector<Pose2>& way) {
    const std::string log = folder.write(name + ".log", test::carmen_log(test::surveyed(world, way, random)));
    const std::string recording = (folder.path() / (name + ".pcapng")).string();
    EXPECT_EQ(run_deltamap({"import", "carmen", log, recording}).exit_code, 0);
    return recording;
  }
  [[nodiscard]] test::ToolRun build(std::vector<std::string> words) const {
    words.insert(words.begin(), {"map", "build"});
    words.insert(words.end(), {"--set", "laser.mount.x_m=0", "--set", "laser.variant=180/1"});
    return run_deltamap(words);
  }
  /// A round of the hall, and the same one again after a container as large as the middle was put there.
  std::string recorded_while_rebuilt() {
    OccupancyGrid later = hall;
    test::fill(later, {3.0, 2.0}, {17.0, 6.2}, CellState::kOccupied);
    const std::vector<Pose2> round = test::rounds_of_the_hall(1);
    std::vector<TrackedScan> scans = test::surveyed(hall, round, random);
    const Pose2 so_far = scans.back().odom_from_robot;
    for (TrackedScan& scan : test::surveyed(later, round, random)) {
      scan.odom_from_robot = so_far * scan.odom_from_robot;
      scans.push_back(std::move(scan));
    }
    const std::string recording = (folder.path() / "rebuilt.pcapng").string();
    EXPECT_EQ(
        run_deltamap({"import", "carmen", folder.write("rebuilt.log", test::carmen_log(scans)), recording}).exit_code,
        0);
    return recording;
  }
  [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }

  test::TemporaryFolder folder;
  std::string yaml = (folder.path() / "hall.yaml").string();
  OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{14};
};

TEST_F(MapBuild, MakesTheMapOfAHallWhoseWheelsAreMetresOff) {
  const std::string one = recorded("one", hall, test::rounds_of_the_hall(2));
  const std::string tum = (folder.path() / "way.tum").string();
  const test::ToolRun run = build({one, yaml, "--json", "--trajectory", tum});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto told = nlohmann::json::parse(run.output);
  EXPECT_GT(told["loops"].get<int>(), 20);
  EXPECT_LT(told["keyframes_by_odometry_alone"].get<int>(), 5);
  EXPECT_EQ(told["drives"][0]["recording"], one);
  // Walls along the axes, the first pose at the origin, looking along one of them.
  std::istringstream start{told["drives"][0]["start"].get<std::string>()};
  Pose2 first;
  char comma = 0;
  start >> first.x >> comma >> first.y >> comma >> first.theta;
  EXPECT_NEAR(std::remainder(first.theta, 90.0), 0.0, 1.0);
  const Pose2 map_from_hall =
      Pose2{first.x, first.y, radians(first.theta)} * inverse(test::rounds_of_the_hall(1).front());
  const OccupancyGrid map = read_grid(yaml);
  EXPECT_EQ(map.width(), told["width"].get<int>());
  const OccupancyGrid truth =
      mapping::registration::transformed_grid(test::drawn_hall(0.05), map_from_hall, map.geometry());
  std::size_t occupied = 0;
  std::size_t right = 0;
  for_each_known(map, [&](Cell cell, CellState state) {
    if (state != CellState::kOccupied) return;
    ++occupied;
    bool near = false;
    for (int row = -2; row <= 2; ++row) {
      for (int column = -2; column <= 2; ++column) {
        near = near || truth.at({cell.column + column, cell.row + row}) == CellState::kOccupied;
      }
    }
    right += near ? 1 : 0;
  });
  EXPECT_GT(occupied, 800U);
  EXPECT_GT(static_cast<double>(right), 0.95 * static_cast<double>(occupied));
  EXPECT_EQ(simulation::score::read_trajectory(tum).size(), told["drives"][0]["scans"].get<std::size_t>());
}

TEST_F(MapBuild, PutsTwoDrivesTogetherAndTellsWhereTheyBegan) {
  const std::string one = recorded("one", hall, test::rounds_of_the_hall(1));
  const std::vector<Pose2> way = test::way_along({{18.7, 6.8}, {2.0, 6.8}, {1.6, 1.4}, {12.0, 1.4}});
  const test::ToolRun run = build({one, recorded("two", hall, way), yaml, "--keep-frame", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto told = nlohmann::json::parse(run.output);
  EXPECT_EQ(told["drives"][0]["start"], "0.000,0.000,0.00");
  std::istringstream start{told["drives"][1]["start"].get<std::string>()};
  Pose2 second;
  char comma = 0;
  start >> second.x >> comma >> second.y;
  const Pose2 truth = motion_between(test::rounds_of_the_hall(1).front(), way.front());
  EXPECT_NEAR(second.x, truth.x, 0.15);
  EXPECT_NEAR(second.y, truth.y, 0.15);
}

TEST_F(MapBuild, WritesNothingOfADriveThatItCannotPlace) {
  const std::string one = recorded("one", hall, test::rounds_of_the_hall(1));
  OccupancyGrid other{{500, 500, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (double x = 1.0; x < 24.0; x += 3.1) test::fill(other, {x, 3.0}, {x + 0.4, 3.4}, CellState::kOccupied);
  const test::ToolRun run =
      build({one, recorded("elsewhere", other, test::way_along({{2.0, 5.0}, {18.0, 5.0}})), yaml});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("elsewhere.pcapng: not found in what the drives before it have seen"), std::string::npos)
      << run.errors;
  EXPECT_FALSE(exists("hall.yaml") || exists("hall.pgm"));
}

TEST_F(MapBuild, WritesAFalseMapByForceAlone) {
  const std::string rebuilt = recorded_while_rebuilt();
  const std::string png = (folder.path() / "doubts.png").string();
  const test::ToolRun refused = build({rebuilt, yaml, "--json", "--picture", png});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("false: "), std::string::npos) << refused.errors;
  EXPECT_NE(refused.errors.find("not written, the map is false"), std::string::npos) << refused.errors;
  EXPECT_FALSE(exists("hall.yaml") || exists("hall.pgm"));
  EXPECT_TRUE(exists("doubts.png"));
  const auto told = nlohmann::json::parse(refused.output);
  EXPECT_TRUE(told["quality"]["false"].get<bool>());
  EXPECT_FALSE(told["written"].get<bool>());
  const test::ToolRun forced = build({rebuilt, yaml, "--force"});
  EXPECT_EQ(forced.exit_code, 0) << forced.errors;
  EXPECT_NE(forced.errors.find("false: "), std::string::npos) << forced.errors;
  EXPECT_TRUE(exists("hall.yaml") && exists("hall.pgm"));
}

TEST_F(MapBuild, IsJudgedAgainByMapQuality) {
  const std::string one = recorded("one", hall, test::rounds_of_the_hall(2));
  const std::string tum = (folder.path() / "way.tum").string();
  ASSERT_EQ(build({one, yaml, "--trajectory", tum}).exit_code, 0);
  const auto quality = [&](const std::string& map) {
    return run_deltamap({"map", "quality", map, one, "--trajectory", tum, "--json", "--set", "laser.mount.x_m=0",
                         "--set", "laser.variant=180/1"});
  };
  const test::ToolRun good = quality(yaml);
  EXPECT_EQ(good.exit_code, 0) << good.errors;
  const auto told = nlohmann::json::parse(good.output);
  EXPECT_FALSE(told["false"].get<bool>());
  EXPECT_GT(told["pairs_compared"].get<int>(), 50);
  const std::string other = (folder.path() / "other.yaml").string();
  write_grid(OccupancyGrid{read_grid(yaml).geometry(), CellState::kFree}, other);
  const test::ToolRun wrong = quality(other);
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_TRUE(nlohmann::json::parse(wrong.output)["flaws"]["unfit_scans"]["beyond_limit"].get<bool>());
}

TEST_F(MapBuild, NamesWhatIsWrongAndWritesNothing) {
  const std::string one = recorded("one", hall, test::way_along({{1.5, 1.2}, {4.0, 1.2}}));
  const std::string missing = (folder.path() / "missing.pcapng").string();
  const std::string no_recording = folder.write("notes.pcapng", "no recording");
  const struct {
    std::vector<std::string> words;
    int exit_code;
    std::string named;
  } cases[] = {{{one}, 2, "FILES"},
               {{one, one}, 2, "must end in .yaml"},
               {{missing, yaml}, 1, "missing.pcapng"},
               {{no_recording, yaml}, 1, "notes.pcapng"},
               {{one, yaml, "--resolution", "0"}, 2, "--resolution"},
               {{one, yaml, "--trajectory", one}, 1, "one.pcapng"},
               {{one, one, yaml}, 1, "given twice"},
               {{one, yaml, "--trajectory", yaml}, 1, "is a file of the map"},
               {{one, yaml, "--set", "laser.variant=7"}, 2, "laser.variant"}};
  for (const auto& wrong : cases) {
    std::vector<std::string> words{"map", "build"};
    words.insert(words.end(), wrong.words.begin(), wrong.words.end());
    const test::ToolRun run = run_deltamap(words);
    EXPECT_EQ(run.exit_code, wrong.exit_code) << run.errors;
    EXPECT_NE(run.errors.find(wrong.named), std::string::npos) << run.errors;
    EXPECT_FALSE(exists("hall.yaml") || exists("hall.pgm")) << wrong.named;
  }
}

TEST_F(MapBuild, ReadsARecordingUpToItsCutAndSaysSo) {
  const std::string one = recorded("one", hall, test::way_along({{1.5, 1.2}, {12.0, 1.2}}));
  std::filesystem::resize_file(one, std::filesystem::file_size(one) / 2);
  const test::ToolRun run = build({one, yaml});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.errors.find("warning: " + one), std::string::npos) << run.errors;
  EXPECT_NE(run.output.find("no place was seen twice"), std::string::npos) << run.output;
  EXPECT_TRUE(exists("hall.yaml") && exists("hall.pgm"));
}

}  // namespace
}  // namespace deltamap::tool
