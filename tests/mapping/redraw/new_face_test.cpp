// SPDX-License-Identifier: Apache-2.0
// What belongs to a new face: no gaps in it, no known floor behind it; and what is no face at all, because it toggles
// or because it is a speck.
#include <gtest/gtest.h>

#include "mapping/redraw/cell_group.hpp"
#include "mapping/redraw/enclosed_free_space.hpp"
#include "mapping/redraw/ray_counts.hpp"
#include "mapping/votes/face_step.hpp"
#include "mapping/votes/flip_memory.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::redraw {
namespace {

using votes::FaceParams;
using votes::FlipMemory;
using votes::Question;

const OccupancyGrid& closed_box() {
  static const OccupancyGrid grid = test::drawn_grid({
      "............",  //
      "...#####....",  //
      "...#...#....",  //
      "...#...#....",  //
      "...#...#....",  //
      "...#####....",  //
      "............",  //
  });
  return grid;
}

TEST(HiddenFloor, IsTheInsideOfWhatIsClosed) {
  const std::vector<Cell> starts{{4, 3}, {2, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  const std::vector<Cell> hidden = enclosed_free_space(closed_box(), starts, robot, 40.0);
  EXPECT_EQ(hidden.size(), 9U);
  for (const Cell& cell : hidden) EXPECT_TRUE(cell.column > 3 && cell.column < 7 && cell.row > 1 && cell.row < 5);
}

TEST(HiddenFloor, IsNotWhereTheRobotWas) {
  const std::vector<Cell> starts{{4, 3}};
  EXPECT_TRUE(enclosed_free_space(closed_box(), starts, std::vector<Point2>{{5.5, 3.5}}, 40.0).empty());
}

TEST(HiddenFloor, IsNotMoreThanWasAllowed) {
  const std::vector<Cell> starts{{4, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  EXPECT_TRUE(enclosed_free_space(closed_box(), starts, robot, 4.0).empty());
}

TEST(HiddenFloor, DoesNotLeakThroughACrack) {
  OccupancyGrid cracked = closed_box();
  cracked.set({3, 3}, CellState::kFree);
  const std::vector<Cell> starts{{4, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  EXPECT_EQ(enclosed_free_space(cracked, starts, robot, 40.0).size(), 10U);  // the crack itself too
}

/// A box of 40 × 40 cells of 5 cm in a field of 80 × 80, its corners left out for so many cells each way.
OccupancyGrid box_without_corners(int left_out) {
  OccupancyGrid grid{{80, 80, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (int i = 20 + left_out; i <= 60 - left_out; ++i) {
    for (const Cell& cell : {Cell{i, 20}, Cell{i, 60}, Cell{20, i}, Cell{60, i}}) grid.set(cell, CellState::kOccupied);
  }
  return grid;
}

TEST(HiddenFloor, DoesNotLeakThroughCornersThatNoBeamHasMet) {
  const std::vector<Cell> starts{{40, 21}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  const std::vector<Cell> hidden = enclosed_free_space(box_without_corners(3), starts, robot, 40.0);
  EXPECT_GE(hidden.size(), 39U * 39U - 4U);  // into the corners, but for their last cells
  EXPECT_LE(hidden.size(), 41U * 41U);
  EXPECT_TRUE(enclosed_free_space(box_without_corners(8), starts, robot, 40.0).empty()) << "0.5 m are a way in";
}

TEST(HiddenFloor, IsOpenThroughAWideGap) {
  OccupancyGrid open = closed_box();
  for (int row = 2; row <= 4; ++row) open.set({3, row}, CellState::kFree);
  const std::vector<Cell> starts{{5, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  EXPECT_TRUE(enclosed_free_space(open, starts, robot, 40.0).empty());
}

TEST(HiddenFloor, OutsideTheMapAndOnSurfacesThereIsNone) {
  const std::vector<Cell> starts{{-1, 3}, {100, 100}, {3, 3}};
  EXPECT_TRUE(enclosed_free_space(closed_box(), starts, std::vector<Point2>{{0.5, 0.5}}, 40.0).empty());
}

std::vector<std::size_t> face_steps(const std::vector<Point2>& ends) {
  std::vector<std::size_t> steps;
  votes::for_each_face_step(
      ends.size(), votes::FaceParams{.bearing_step_rad = radians(1.0)}, [&](std::size_t i) { return ends[i].norm(); },
      [&](std::size_t i) -> const Point2& { return ends[i]; }, [&](std::size_t i) { steps.push_back(i); });
  return steps;
}

TEST(FaceStep, JoinsTheMiddleOfAStraightFace) {
  EXPECT_EQ(face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.0, 0.4}, {10.0, 0.6}, {10.0, 0.8}}),
            (std::vector<std::size_t>{1, 2}));
}

TEST(FaceStep, CutsNoCorner) {
  EXPECT_TRUE(face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.1, 0.4}, {10.3, 0.4}, {10.5, 0.4}}).size() <= 1U);
  for (const std::size_t step : face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.1, 0.4}, {10.3, 0.4}, {10.5, 0.4}}))
    EXPECT_NE(step, 1U);
}

TEST(FaceStep, JoinsNothingAcrossAStepInDepth) {
  EXPECT_TRUE(face_steps({{10.0, 0.0}, {10.0, 0.2}, {12.0, 0.4}, {12.0, 0.6}}).empty());
}

TEST(FaceStep, NeedsFourBeams) {
  EXPECT_TRUE(face_steps({}).empty());
  EXPECT_TRUE(face_steps({{10.0, 0.0}}).empty());
  EXPECT_TRUE(face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.0, 0.4}}).empty());
}

TEST(FlipMemory, CallsTogglingWhatIsWrittenBackAndForth) {
  votes::FlipMemory memory{{}};
  memory.note(7, votes::Question::kAdded, 1'000);
  memory.note(7, votes::Question::kRemoved, 121'000);
  EXPECT_LT(memory.beyond(7, 121'000), 0.0);
  memory.note(7, votes::Question::kAdded, 241'000);
  EXPECT_LT(memory.beyond(7, 241'000), 0.0);  // a slot that was emptied and filled, once more
  memory.note(7, votes::Question::kRemoved, 361'000);
  EXPECT_GE(memory.beyond(7, 361'000), 0.0);
  EXPECT_LT(memory.beyond(8, 361'000), 0.0);
}

TEST(FlipMemory, ForgetsInTime) {
  votes::FlipMemory memory{{}};
  for (std::uint32_t i = 0; i < 6; ++i)
    memory.note(7, i % 2 == 0 ? votes::Question::kAdded : votes::Question::kRemoved, 1'000 * i);
  EXPECT_GE(memory.beyond(7, 6'000), 0.0);
  EXPECT_LT(memory.beyond(7, 6'000 + 4 * 3'600'000), 0.0);
}

TEST(FlipMemory, AContainerASlotAnHourIsNoToggling) {
  votes::FlipMemory memory{{}};
  for (std::uint32_t hour = 0; hour < 10; ++hour) {
    memory.note(7, hour % 2 == 0 ? votes::Question::kAdded : votes::Question::kRemoved, 3'600'000 * hour);
    EXPECT_LT(memory.beyond(7, 3'600'000 * hour), 0.0);
  }
}

TEST(VoteLayer, KeepsPlacesApartWhereATileHasHadToGo) {
  votes::VoteLayer layer{{.most_tiles = 1}, GridGeometry{1000, 1000, 0.1, {0.0, 0.0}}};
  const Cell near{5, 5};
  const Cell far{900, 900};
  layer.vote(votes::Question::kAdded, far, true, 1'000);
  layer.vote(votes::Question::kAdded, near, true, 2'000);  // takes the only tile
  EXPECT_EQ(layer.ballot(votes::Question::kAdded, far, 2'000).yes, 0.0F);
  layer.vote(votes::Question::kAdded, far, true, 3'000);
  EXPECT_EQ(layer.ballot(votes::Question::kAdded, near, 3'000).yes, 0.0F);
  EXPECT_EQ(layer.ballot(votes::Question::kAdded, far, 3'000).yes, 1.0F);
}

TEST(VoteLayer, LetsVotesLapseWhereNobodyVotesAnyMore) {
  votes::VoteLayer layer{{.forget_s = 10.0}, GridGeometry{100, 100, 0.1, {0.0, 0.0}}};
  layer.vote(votes::Question::kAdded, {5, 5}, true, 1'000);
  EXPECT_EQ(layer.ballot(votes::Question::kAdded, {5, 5}, 11'000).yes, 1.0F);
  EXPECT_EQ(layer.ballot(votes::Question::kAdded, {5, 5}, 11'001).yes, 0.0F);
}

TEST(CellGroup, CountsDiagonalsAndStopsAtEnough) {
  const OccupancyGrid grid = test::drawn_grid({
      "#.....",  //
      ".#..##",  //
      "..#...",  //
  });
  EXPECT_EQ(group_size(grid, {0, 2}, 10), 3);
  EXPECT_EQ(group_size(grid, {0, 2}, 2), 2);
  EXPECT_EQ(group_size(grid, {4, 1}, 10), 2);
}

TEST(RayCounts, CountNothingBehindAnOpaqueCell) {
  const OccupancyGrid world = test::drawn_grid({"...........#"}, 0.1);
  Random random{1};
  TrackedScan scan = test::seen_scan(world, {0.05, 0.05, 0.0}, 0.0, random);
  for (Beam& beam : scan.scan.beams) beam.kind = BeamKind::kNotValid;
  scan.scan.beams[90] = {1.1F, 0.0F, BeamKind::kRange};
  scan.rays[90].end = {1.1F, 0.0F};
  const CellBox all{{0, 0}, {12, 1}};
  RayCounts open{world.geometry(), all};
  open.add({&scan, scan.estimate.map_from_robot}, 20.0, 0.2);
  EXPECT_GT((open[{11, 0}].hits), 0);
  EXPECT_GT((open[{8, 0}].passes), 0);
  RayCounts shut{world.geometry(), all};
  OccupancyGrid walls = world;
  walls.set({5, 0}, CellState::kOccupied);
  walls.set({3, 0}, CellState::kOccupied);
  shut.stop_at(walls, [](Cell cell) { return cell.column == 5; });
  shut.add({&scan, scan.estimate.map_from_robot}, 20.0, 0.2);
  EXPECT_EQ((shut[{11, 0}].hits), 0);
  EXPECT_EQ((shut[{8, 0}].passes), 0);
  EXPECT_GT((shut[{5, 0}].passes), 0);
}

}  // namespace
}  // namespace deltamap::mapping::redraw
