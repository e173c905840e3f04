// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/survey_step.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::daemon {
namespace {

using test::survey_time;

TEST(SurveyStep, LeavesOutScansThatNoOdometrySpeaksForAndPlacesAllOthers) {
  Random random{3};
  const OccupancyGrid hall = test::drawn_hall(0.05);
  const std::vector<Pose2> way = test::way_along({{1.5, 7.0}, {6.0, 7.0}});
  SurveyStep step{Settings{}};
  step.begin_drive();
  Scan too_early = test::seen_scan(hall, way.front(), 0.01, random).scan;
  too_early.time = survey_time(-2.0);
  step.observe(too_early);
  for (std::size_t i = 0; i < way.size(); ++i) {
    Odometry odometry;
    odometry.time = survey_time(0.5 * static_cast<double>(i));
    odometry.odom_from_robot = motion_between(way.front(), way[i]);
    step.observe(odometry);
    for (const double later_s : {0.0, 0.05}) {
      Scan scan = test::seen_scan(hall, way[i], 0.01, random).scan;
      scan.time = odometry.time + duration_from_seconds(later_s);
      step.observe(std::move(scan));
    }
  }
  Scan unheard = test::seen_scan(hall, way.back(), 0.01, random).scan;
  unheard.time = survey_time(0.5 * static_cast<double>(way.size()) + 5.0);
  step.observe(unheard);
  const std::size_t scans = step.end_drive();
  ASSERT_TRUE(step.finish());
  EXPECT_EQ(scans, 2 * way.size()) << "one came before the wheels' first report, one after they had fallen silent";
  const std::vector<TrajectoryPoint> trajectory = step.trajectory();
  ASSERT_EQ(trajectory.size(), scans);
  EXPECT_LT(step.slam().survey().keyframes.size(), way.size()) << "not each is a keyframe";
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Pose2 truth = motion_between(way.front(), way[i]);
    EXPECT_LT(distance_between(trajectory[2 * i].map_from_robot, truth), 0.05) << i;
  }
}

}  // namespace
}  // namespace deltamap::daemon
