// SPDX-License-Identifier: Apache-2.0
// The picture of an incident: what its pixels say.
#include "daemon/incidents/incident_picture.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "daemon/incidents/incident_list.hpp"
#include "tests/support/daemon/incident_drive.hpp"
#include "tests/support/daemon/incident_pixels.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

using namespace test::incident_colours;
using test::Pixels;
using test::pixels_of;

/// A wall 3 m ahead of the robot, and nothing else.
OccupancyGrid wall_ahead() {
  OccupancyGrid map{GridGeometry{200, 200, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (int row = 0; row < 200; ++row) map.set({160, row}, CellState::kOccupied);
  return map;
}

Scan three_beams(float ahead_m) {
  Scan scan;
  scan.first_bearing_rad = -0.1;
  scan.bearing_step_rad = 0.1;
  scan.beams.assign(3, {.range_m = ahead_m, .kind = BeamKind::kRange});
  return scan;
}

TEST(IncidentPicture, BeamsThatEndWhereTheMapHasAnObstacleAreGreenAndOthersOrange) {
  const OccupancyGrid map = wall_ahead();
  const Pose2 robot{5.0, 5.0, 0.0};
  const Pixels fits = pixels_of(incident_picture({.map = map, .map_from_robot = robot, .scan = three_beams(3.02F)}));
  EXPECT_GT(fits.count(kGreen), 0u);
  EXPECT_EQ(fits.count(kOrange), 0u);
  const Pixels doubted = pixels_of(incident_picture({.map = map, .map_from_robot = robot, .scan = three_beams(1.5F)}));
  EXPECT_EQ(doubted.count(kGreen), 0u);
  EXPECT_GT(doubted.count(kOrange), 0u);
}

TEST(IncidentPicture, ShowsMapPoseAndTheOtherPoseAndIsOfBoundedSize) {
  const OccupancyGrid map = wall_ahead();
  PoseCovariance covariance = PoseCovariance::Zero();
  const auto shown = [&](std::optional<Pose2> other, float range_m) {
    return pixels_of(incident_picture({.map = map,
                                       .map_from_robot = {5.0, 5.0, 0.0},
                                       .covariance = covariance,
                                       .map_from_other = other,
                                       .scan = three_beams(range_m)}));
  };
  const Pixels sure = shown(std::nullopt, 3.0F);
  EXPECT_LE(sure.side, 800u);
  EXPECT_GT(sure.count(kBlack), 100u);
  EXPECT_GT(sure.count(kBlue), 50u);
  EXPECT_EQ(sure.count(kPurple), 0u);
  EXPECT_GT(shown(Pose2{3.0, 3.0, 1.0}, 3.0F).count(kPurple), 50u);
  covariance(0, 0) = covariance(1, 1) = 1.0;
  EXPECT_GT(shown(std::nullopt, 3.0F).count(kBlue), sure.count(kBlue) + 100) << "an ellipse of 2 m";
  EXPECT_LE(shown(Pose2{1e6, -1e6, 0.0}, 80.0F).side, 800u);
}

class IncidentPictureTest : public test::IncidentDrive {};

TEST_F(IncidentPictureTest, EachIncidentHasOneWithTheScanOfItsMoment) {
  start();
  drive(60.0);
  (void)mark("");
  ASSERT_EQ(kept().size(), 1u);
  const Pixels pixels = pixels_of(test::content_of(kept().front().folder / kIncidentPicture));
  EXPECT_GT(pixels.count(kBlack), 100u);
  EXPECT_GT(pixels.count(kGreen), 3 * (pixels.count(kOrange) + 1)) << "the map is right, and so is the pose";
  EXPECT_GT(pixels.count(kBlue), 50u);
  EXPECT_NE(picture_of_incident(settings_.incidents.folder, kept().front().incident.name), std::nullopt);
  EXPECT_EQ(picture_of_incident(settings_.incidents.folder, ".."), std::nullopt);
}

}  // namespace
}  // namespace deltamap::daemon
