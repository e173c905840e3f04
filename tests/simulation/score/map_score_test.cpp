// SPDX-License-Identifier: Apache-2.0
// How maps are held against the truth: contours paired one to one, skill, what is kept, and what could be known at
// best.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/start_map.hpp"
#include "simulation/score/change_watch.hpp"
#include "simulation/score/map_score.hpp"
#include "simulation/score/map_truth.hpp"
#include "tests/support/worlds/block_room.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::simulation::score {
namespace {

CellMask everywhere(const OccupancyGrid& grid) { return CellMask(grid.geometry().cell_count(), 1); }

TEST(MapScore, OfTheTruthItselfIsPerfect) {
  const OccupancyGrid truth = test::drawn_grid({"####", "#..#", "####"});
  const MapScore score = map_score(truth, truth, everywhere(truth));
  EXPECT_EQ(score.contour_f1, 1.0);
  EXPECT_EQ(score.acceptance, 1.0);
  EXPECT_EQ(score.wrong_m2, 0.0);
}

TEST(MapScore, PairsANeighbourOnceOnly) {
  const OccupancyGrid truth = test::drawn_grid({"......", ".####.", "......"});
  const OccupancyGrid beside = test::drawn_grid({".####.", "......", "......"});
  EXPECT_EQ(map_score(truth, beside, everywhere(truth)).contour_f1, 1.0);
  const OccupancyGrid thick = test::drawn_grid({".####.", ".####.", "......"});
  EXPECT_NEAR(map_score(truth, thick, everywhere(truth)).contour_f1, 2.0 * 4.0 / 12.0, 1e-12);
}

TEST(MapScore, ASlantingSurfaceMayBeDrawnWithoutTheCellsThatItClips) {
  const OccupancyGrid truth = test::drawn_grid({"##....", ".##...", "..##..", "...##.", "....##"});
  const auto f1 = [&](const std::vector<std::string>& lines) {
    return map_score(truth, test::drawn_grid(lines), everywhere(truth)).contour_f1;
  };
  EXPECT_GT(f1({"#.....", ".#....", "..#...", "...#..", "....##"}), 0.9) << "on its other side, all but an end";
  EXPECT_EQ(f1({"##....", "..#...", "...#..", "....#.", ".....#"}), 1.0);
  EXPECT_EQ(f1({"##....", ".##...", "..##..", "...##.", "....##"}), 1.0);
  EXPECT_LT(f1({"#.....", "......", "..#...", "......", "....##"}), 0.9) << "gaps";
  EXPECT_LT(f1({"###...", ".###..", "..###.", "...###", "....##"}), 0.9) << "too thick";
  const OccupancyGrid flat = test::drawn_grid({"......", "###...", "..####"});
  EXPECT_EQ(map_score(flat, test::drawn_grid({"......", "##....", "..####"}), everywhere(flat)).contour_f1, 1.0);
}

TEST(MapScore, TheCornersOfThingsMustBeDrawn) {
  const OccupancyGrid truth = test::drawn_grid({"#####", "#...#", "#...#", "#####"});
  const OccupancyGrid without = test::drawn_grid({".###.", "#...#", "#...#", ".###."});
  EXPECT_LT(map_score(truth, without, everywhere(truth)).contour_f1, 0.9);
}

TEST(MapScore, CountsWhatIsMissingAndWhatIsTooMuch) {
  const OccupancyGrid truth = test::drawn_grid({"##....", "......", "......"});
  const OccupancyGrid other = test::drawn_grid({"......", "......", "....##"});
  const MapScore score = map_score(truth, other, everywhere(truth));
  EXPECT_EQ(score.contour_f1, 0.0);
  EXPECT_EQ(score.wrong_m2, 4.0);
}

TEST(MapScore, AsksNothingWhereNobodyCanSee) {
  const OccupancyGrid truth = test::drawn_grid({"#...  ", "#...  "});
  const OccupancyGrid map = test::drawn_grid({"#....#", "#....#"});
  EXPECT_EQ(map_score(truth, map, everywhere(truth)).contour_f1, 1.0);
}

TEST(MapScore, SkillIsTheShareOfTheWayToTheBest) {
  EXPECT_DOUBLE_EQ(skill(0.9, 0.8, 1.0), 0.5);
  EXPECT_LT(skill(0.7, 0.8, 1.0), 0.0);
  EXPECT_TRUE(std::isnan(skill(0.9, 1.0, 1.0)));
}

TEST(MapScore, KeptIsWhatStillHasASurfaceBeside) {
  const OccupancyGrid first = test::drawn_grid({"####", "....", "...."});
  const OccupancyGrid after = test::drawn_grid({"#...", "....", "...#"});
  EXPECT_DOUBLE_EQ(share_kept(first, after, everywhere(first)), 0.25);
  EXPECT_TRUE(std::isnan(share_kept(first, after, CellMask(12, 0))));
}

const Scenario& room() {
  static const Scenario scenario = test::block_room();
  return scenario;
}

TEST(MapTruth, ThePerfectMapperKnowsOnlyWhatBeamsHaveTouched) {
  const OccupancyGrid first = start_map(room(), 0.05);
  MapTruth truth{room(), first};
  ChangeWatch watch{room(), first.geometry()};
  const Change gone{ChangeKind::kRemoved, room().world.largest_id(), {{3.5, 1.5}, 1.0, 1.0, 0.0}, {}};
  watch.apply(gone, Timestamp{}, {1.0, 1.0});
  truth.see(watch.world());
  EXPECT_EQ(truth.perfect(), first);
  EXPECT_EQ(map_score(truth.visible(), truth.perfect(), truth.seen()).contour_f1, 1.0);  // of nothing seen

  truth.touch(watch.view_from({1.0, 1.5, 0.0}, 20.0, 181, {}));
  const CellMask seen = truth.seen();
  EXPECT_GT(map_score(truth.visible(), truth.perfect(), seen).contour_f1,
            map_score(truth.visible(), first, seen).contour_f1);
  const Cell face = first.geometry().cell_at({3.0, 1.5});
  EXPECT_EQ(first[face], CellState::kOccupied);
  EXPECT_EQ(truth.perfect()[face], CellState::kFree);
  EXPECT_EQ(truth.last_passed()[first.geometry().index_of(face)], 1);
}

TEST(MapTruth, InsidesCountAsOccupiedOnlyInTheSolidTruth) {
  const OccupancyGrid first = start_map(room(), 0.05);
  const MapTruth truth{room(), first};
  const Cell inside = first.geometry().cell_at({3.5, 1.5});
  EXPECT_EQ(truth.visible()[inside], CellState::kUnknown);
  EXPECT_EQ(truth.solid()[inside], CellState::kOccupied);
}

TEST(MapTruth, TellsHowFarTheOuterWallsHaveMoved) {
  const OccupancyGrid first = start_map(room(), 0.05);
  const MapTruth truth{room(), first};
  for (const double wall_m : truth.wall_drift(first, first)) EXPECT_EQ(wall_m, 0.0);
  OccupancyGrid moved{first.geometry()};
  for (std::size_t i = 0; i < first.geometry().cell_count(); ++i) {
    const Cell cell = first.geometry().cell_of(i);
    moved.set(cell, first.at({cell.column - 1, cell.row}));
  }
  const auto drift = truth.wall_drift(first, moved);
  ASSERT_EQ(drift.size(), 4U) << "lower, right, upper, left, as the wall is drawn";
  EXPECT_NEAR(drift[0], 0.0, 0.01);
  EXPECT_NEAR(drift[1], 0.05, 0.01);  // the ends of the walls beside count too
  EXPECT_NEAR(drift[3], -0.05, 0.01);
}

TEST(MapTruth, KnowsTheFloorOnWhichAThingHasBeenPutWhereTheRobotStarted) {
  const Scenario scenario = room();
  MapTruth truth{scenario, start_map(scenario, 0.05)};
  const auto free_cells = [&] { return count_of(truth.visible(), CellState::kFree); };
  const auto before = free_cells();
  const Box box{scenario.robot.map_from_start.position(), 0.6, 0.4, 0.3};
  truth.see(scenario.world.with({99, ObjectKind::kContainer, box}));
  EXPECT_GT(free_cells(), before * 9 / 10);
  EXPECT_LT(free_cells(), before);
}

}  // namespace
}  // namespace deltamap::simulation::score
