// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files/grid_file.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/merge/merge_trial.hpp"
#include "tests/support/worlds/drawn_grid.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::tool {
namespace {

using test::ToolRun;

ToolRun run(std::vector<std::string> words) {
  words.insert(words.begin(), "map");
  return test::run_deltamap(words);
}

class MapTool : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  test::TemporaryFolder folder_;
};

class MapMergeTool : public MapTool, public testing::WithParamInterface<const char*> {};

TEST_P(MapMergeTool, FindsTheTransformAndWritesOnTheCellsOfA) {
  const OccupancyGrid hall = test::drawn_hall(0.1);
  const Pose2 b_from_a{2.0, -1.0, radians(33.3)};
  write_grid(hall, file("a.yaml"));
  write_grid(test::moved_grid(test::drawn_hall(0.05), b_from_a, 0.1), file("b.yaml"));
  std::vector<std::string> arguments{"merge",    file("a.yaml"), file("b.yaml"), "--method",
                                     GetParam(), "--out",        file("c.yaml"), "--json"};
  const Pose2 a_from_b = inverse(b_from_a);
  if (std::string{GetParam()} == "prior") {
    arguments.push_back("--prior=" + std::to_string(a_from_b.x + 0.1) + "," + std::to_string(a_from_b.y - 0.1) + "," +
                        std::to_string(degrees(a_from_b.theta) + 1.0));
  }
  const ToolRun merged = run(arguments);
  ASSERT_EQ(merged.exit_code, 0) << merged.errors;
  const auto json = nlohmann::json::parse(merged.output);
  EXPECT_NEAR(json["theta_deg"].get<double>(), degrees(a_from_b.theta), 1.0);
  EXPECT_NEAR(json["x_m"].get<double>(), a_from_b.x, 0.3);
  EXPECT_NEAR(json["y_m"].get<double>(), a_from_b.y, 0.3);
  EXPECT_GT(json["acceptance"].get<double>(), 0.97);
  EXPECT_GT(json["surface_agreement"].get<double>(), 0.8);
  EXPECT_EQ(json["refusal"], "none");
  EXPECT_EQ(read_grid(file("c.yaml")).geometry(), hall.geometry());
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, MapMergeTool, testing::Values("ma1", "ma2", "ma3", "ma4", "global", "prior"));

TEST_F(MapTool, RefusedMergesTellTheReasonAndWriteNothing) {
  write_grid(test::drawn_hall(), file("a.yaml"));
  write_grid(OccupancyGrid{{50, 50, 0.1, {0.0, 0.0}}, CellState::kFree}, file("b.yaml"));
  const ToolRun merged = run({"merge", file("a.yaml"), file("b.yaml"), "--out", file("c.yaml"), "--json"});
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(merged.output)["refusal"], "too few points");
  EXPECT_NE(merged.errors.find("b.yaml: not merged into"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file("c.yaml")));
}

TEST_F(MapTool, MergingWantsAPriorExactlyWithItsMethod) {
  write_grid(test::drawn_hall(), file("a.yaml"));
  EXPECT_EQ(run({"merge", file("a.yaml"), file("a.yaml"), "--method", "prior", "--out", file("c.yaml")}).exit_code, 2);
  EXPECT_EQ(run({"merge", file("a.yaml"), file("a.yaml"), "--prior", "0,0,0", "--out", file("c.yaml")}).exit_code, 2);
  EXPECT_EQ(run({"merge", file("a.yaml"), file("a.yaml"), "--method", "ma9", "--out", file("c.yaml")}).exit_code, 2);
}

TEST_F(MapTool, ForeignFilesEndWithOneLineThatNamesThem) {
  write_grid(test::drawn_hall(), file("a.yaml"));
  folder_.write("cut.yaml", "image: a.pgm\nresolution: much\n");
  for (const std::string command : {"merge", "compare"}) {
    std::vector<std::string> arguments{command, file("a.yaml"), file("cut.yaml")};
    if (command == "merge") arguments.insert(arguments.end(), {"--out", file("c.yaml")});
    const ToolRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("cut.yaml: line 2"), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
  }
}

TEST_F(MapTool, ComparingPrintsWhatIsCountedByHand) {
  write_grid(test::drawn_grid({"##.. ", "....."}), file("a.yaml"));
  write_grid(test::drawn_grid({"#...#", "..#.."}), file("b.yaml"));
  const ToolRun compared = run({"compare", file("a.yaml"), file("b.yaml"), "--json"});
  ASSERT_EQ(compared.exit_code, 0) << compared.errors;
  const auto json = nlohmann::json::parse(compared.output);
  // Upper row: # on #, # on '.', '.' twice on '.'; the fifth is unknown. Lower row: one '#' on '.', four agree.
  EXPECT_EQ(json["agreeing_cells"], 7);
  EXPECT_EQ(json["disagreeing_cells"], 2);
  EXPECT_NEAR(json["acceptance"].get<double>(), 7.0 / 9.0, 1e-12);
  // The second '#' of A pairs with its neighbour below to the right; the one where A is unknown does not count.
  EXPECT_NEAR(json["contour_f1"].get<double>(), 1.0, 1e-12);
  EXPECT_NE(run({"compare", file("a.yaml"), file("b.yaml")}).output.find("contour F1           1.0000"),
            std::string::npos);
}

}  // namespace
}  // namespace deltamap::tool
