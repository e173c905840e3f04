// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/drive_joining.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

class TwoDrives : public testing::Test {
 protected:
  void drive(const OccupancyGrid& world, const std::vector<Pose2>& way) {
    const auto number = static_cast<std::uint32_t>(survey.component.size());
    survey.component.push_back(number);
    double driven_m = 0.0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      if (i > 0) driven_m += distance_between(way[i - 1], way[i]);
      survey.add(keyframe(test::seen_scan(world, way[i], 0.01, random), number, driven_m));
      survey.poses.back() = motion_between(way.front(), way[i]);
      truth.push_back(way[i]);
      if (number > 0) joining.search_from(static_cast<std::uint32_t>(survey.keyframes.size() - 1));
    }
  }

  OccupancyGrid hall = test::drawn_hall(0.05);
  Random random{12};
  Survey survey;
  DriveJoining joining{survey};
  std::vector<Pose2> truth;
};

TEST_F(TwoDrives, AreJoinedWhereTheSecondOneWas) {
  drive(hall, test::rounds_of_the_hall(1));
  drive(hall, test::way_along({{18.7, 6.8}, {2.0, 6.8}, {1.6, 1.4}, {9.0, 1.4}}));
  const auto link = joining.link();
  ASSERT_TRUE(link);
  const Pose2 off = motion_between(motion_between(truth[link->from], truth[link->to]), link->from_from_to);
  EXPECT_LT(off.position().norm(), 0.05);
  EXPECT_LT(std::abs(off.theta), 0.01);
  EXPECT_FALSE(joining.link()) << "all is forgotten";
}

TEST_F(TwoDrives, StayApartWhereTheHallIsItsOwnImage) {
  // Four containers alike, one in each corner: what is seen fits after half a turn, too.
  OccupancyGrid alike{{400, 400, 0.05, {-10.0, -10.0}}, CellState::kFree};
  test::fill(alike, {-9.0, -9.1}, {9.0, -9.0}, CellState::kOccupied);
  test::fill(alike, {-9.0, 9.0}, {9.0, 9.1}, CellState::kOccupied);
  test::fill(alike, {-9.1, -9.0}, {-9.0, 9.0}, CellState::kOccupied);
  test::fill(alike, {9.0, -9.0}, {9.1, 9.0}, CellState::kOccupied);
  for (const Point2& corner : {Point2{-5.0, -6.0}, Point2{3.0, -6.0}, Point2{-5.0, 4.0}, Point2{3.0, 4.0}}) {
    test::fill(alike, corner, corner + Point2{2.0, 2.0}, CellState::kOccupied);
  }
  drive(alike, test::way_along({{-7.0, -7.5}, {7.0, -7.5}, {7.0, 7.5}, {-7.0, 7.5}, {-7.0, -7.0}}));
  drive(alike, test::way_along({{7.0, 7.3}, {-7.0, 7.3}, {-7.0, -7.3}}));
  EXPECT_FALSE(joining.link());
}

}  // namespace
}  // namespace deltamap::surveying::slam
