// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/drawn_map.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

/// The hall as seen at the true poses, in a frame that is turned by `turn_rad`.
Survey turned_survey(const OccupancyGrid& hall, double turn_rad) {
  Random random{8};
  Survey survey;
  survey.component = {0, 1};
  for (const Pose2& pose : test::rounds_of_the_hall(1)) {
    survey.add(keyframe(test::seen_scan(hall, pose, 0.005, random), 0, 0.0));
    survey.poses.back() = Pose2{0.0, 0.0, turn_rad} * pose;
  }
  return survey;
}

/// In the cell of the place, or beside it.
bool is_wall_near(const OccupancyGrid& hall, const Point2& place) {
  const Cell cell = hall.geometry().cell_at(place);
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) {
      if (hall.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

TEST(DrawnMap, TurnsTheWallsOntoTheAxes) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  for (const double turn_rad : {0.0, 0.3, -0.7}) {
    EXPECT_NEAR(turn_to_axes(turned_survey(hall, turn_rad)), -turn_rad, 0.01) << turn_rad;
  }
}

TEST(DrawnMap, ShowsTheHall) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  const OccupancyGrid drawn = drawn_map(turned_survey(hall, 0.4), {0.0, 0.0, -0.4}, 0.05);
  const auto at = [&](double x, double y) { return drawn.at(drawn.geometry().cell_at({x, y})); };
  EXPECT_EQ(at(5.0, 7.0), CellState::kFree);
  EXPECT_EQ(at(4.5, 4.0), CellState::kUnknown) << "inside a container";
  EXPECT_EQ(at(-3.0, 7.0), CellState::kUnknown);
  std::size_t right = 0;
  for_each_known(drawn, [&](Cell cell, CellState state) {
    right += state == CellState::kOccupied && is_wall_near(hall, drawn.geometry().centre_of(cell)) ? 1 : 0;
  });
  const std::size_t occupied = count_of(drawn, CellState::kOccupied);
  EXPECT_GT(occupied, 1000U);
  EXPECT_GT(static_cast<double>(right), 0.99 * static_cast<double>(occupied));
  EXPECT_NEAR(std::remainder(drawn.geometry().origin.x(), 0.05), 0.0, 1e-9);
}

TEST(DrawnMap, LeavesOutWhatOneBeamAloneHasHitAndDrivesOfOtherFrames) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  Survey survey = turned_survey(hall, 0.0);
  TrackedScan once = survey.keyframes.front().scan.tracked();
  for (Beam& beam : once.scan.beams) beam.kind = BeamKind::kNotValid;
  once.scan.beams[90] = {3.0F, 0.0F, BeamKind::kRange};  // straight ahead: its scan looks along x from beam 0 on
  survey.add(keyframe(once, 0, 0.0));
  survey.poses.back() = {5.0, 7.0, 0.0};
  survey.add(keyframe(survey.keyframes.front().scan.tracked(), 1, 0.0));
  survey.poses.back() = {100.0, 100.0, 0.0};
  const OccupancyGrid drawn = drawn_map(survey, {}, 0.05);
  EXPECT_EQ(drawn.at(drawn.geometry().cell_at({8.0, 7.0})), CellState::kFree);
  EXPECT_LT(drawn.width() * drawn.resolution_m(), 30.0);
}

}  // namespace
}  // namespace deltamap::surveying::slam
