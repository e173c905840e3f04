// SPDX-License-Identifier: Apache-2.0
// What a beam says about the map: a wall at x = 5 m, the robot at the origin looking along x.
#include "mapping/votes/beam_evidence.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::votes {
namespace {

class Beams : public testing::Test {
 protected:
  Beams() { test::fill(map, {5.0, -4.0}, {5.1, 4.0}, CellState::kOccupied); }

  BeamVerdict verdict(double range_m, double bearing_rad = 0.0, BeamKind kind = BeamKind::kRange) {
    TrackedScan tracked;
    tracked.scan.beams.push_back({static_cast<float>(range_m), 0.0F, kind});
    const Point2 end = range_m * Point2{std::cos(bearing_rad), std::sin(bearing_rad)};
    tracked.rays.push_back({{0.0F, 0.0F}, end.cast<float>()});
    tracked.estimate.map_from_robot = pose;
    tracked.estimate.covariance =
        Eigen::Vector3d{position_m * position_m, position_m * position_m, heading_rad * heading_rad}.asDiagonal();
    tracked.estimate.bias_covariance = Eigen::Vector3d{bias_m * bias_m, bias_m * bias_m, 0.0}.asDiagonal();
    tracked.estimate.covariance += tracked.estimate.bias_covariance;
    tracked.estimate.state = state;
    tracked.turn_rate_rad_per_s = turn_rate;
    tracked.scan.range_deviation_m = range_deviation_m;
    return beam_evidence(map, ClearSpace{map, {map.geometry(), 2}}, tracked, {}).front();
  }

  OccupancyGrid map{{220, 200, 0.05, {-1.0, -5.0}}, CellState::kFree};
  Pose2 pose;
  double position_m = 0.03;
  double heading_rad = 0.008;
  double bias_m = 0.0;
  double turn_rate = 0.0;
  double range_deviation_m = kRangeDeviationM;
  LocalizerState state = LocalizerState::kTracking;
};

TEST_F(Beams, AreConsistentWhereTheyEndAtTheWall) {
  for (const double range_m : {5.03, 4.92, 5.2}) {  // all within the pose's uncertainty
    const BeamVerdict beam = verdict(range_m);
    EXPECT_TRUE(beam.ends_at_surface) << range_m;
    EXPECT_FALSE(beam.ends_off_map) << range_m;
    EXPECT_TRUE(beam.passed.empty()) << range_m;
  }
}

TEST_F(Beams, SpeakLessSharplyWhereRangesErrMore) {
  const double interval_m = verdict(5.0).interval_m;
  range_deviation_m = 0.1;
  EXPECT_GT(verdict(5.0).interval_m, interval_m + 0.05);
}

TEST_F(Beams, SpeakAsSharplyWhereAllScansAreOffByAlike) {
  const double interval_m = verdict(5.0).interval_m;
  bias_m = 0.1;
  EXPECT_DOUBLE_EQ(verdict(5.0).interval_m, interval_m) << "the map is drawn and read with the same error";
  bias_m = 0.0;
  position_m = 0.1;
  EXPECT_GT(verdict(5.0).interval_m, 1.5 * interval_m);
}

TEST_F(Beams, SayNothingOfTheScanBeforeWhereTheyHaveNoRange) {
  TrackedScan tracked;
  tracked.estimate.state = LocalizerState::kTracking;
  tracked.scan.beams = {{3.0F, 0.0F, BeamKind::kRange}};
  tracked.rays = {{{0.0F, 0.0F}, {3.0F, 0.0F}}};
  const ClearSpace clear{map, {map.geometry(), 2}};
  std::vector<BeamVerdict> verdicts = beam_evidence(map, clear, tracked, {});
  ASSERT_TRUE(verdicts.front().ends_off_map);
  tracked.scan.beams.front().kind = BeamKind::kBeyondMaximum;
  verdicts = beam_evidence(map, clear, tracked, {}, std::move(verdicts));
  EXPECT_EQ(verdicts.front().length_m, 0.0);
  EXPECT_FALSE(verdicts.front().ends_off_map);
}

TEST_F(Beams, AreShortWhereTheyEndInTheFreeSpaceBefore) {
  const BeamVerdict beam = verdict(3.0);
  EXPECT_TRUE(beam.ends_off_map);
  EXPECT_TRUE(beam.passed.empty());
}

TEST_F(Beams, GoThroughWhereTheyEndClearlyBeyond) {
  const BeamVerdict beam = verdict(7.0);
  ASSERT_EQ(beam.passed.size(), 2u);  // the wall is two cells thick
  EXPECT_EQ(beam.passed.front(), map.geometry().cell_at({5.02, 0.0}));
}

TEST_F(Beams, AreShortWhereTheMapKnowsNothing) {
  test::fill(map, {2.0, -5.0}, {4.0, 5.0}, CellState::kUnknown);
  EXPECT_TRUE(verdict(3.0).ends_off_map);
}

TEST_F(Beams, AreSilentWithoutARangeOrAPose) {
  EXPECT_EQ(verdict(7.0, 0.0, BeamKind::kBeyondMaximum).length_m, 0.0);
  EXPECT_EQ(verdict(7.0, 0.0, BeamKind::kDazzled).length_m, 0.0);
  state = LocalizerState::kLost;
  EXPECT_EQ(verdict(7.0).length_m, 0.0);
  state = LocalizerState::kTracking;
  heading_rad = 0.2;
  EXPECT_EQ(verdict(7.0).length_m, 0.0);
}

TEST_F(Beams, DoNotSpeakAgainstAWallThatTheyMayHavePassedAside) {
  test::fill(map, {5.0, 0.05}, {5.1, 4.0}, CellState::kFree);  // the wall ends beside the beam
  EXPECT_TRUE(verdict(7.0).passed.empty());
}

TEST_F(Beams, DoNotSpeakAgainstAWallThatTheyGraze) {
  map = OccupancyGrid{map.geometry(), CellState::kFree};
  test::fill(map, {0.0, 0.05}, {8.0, 0.1}, CellState::kOccupied);  // along the beam, 5 cm aside
  pose.y = 0.06;                                                   // the estimate is wrong by so much
  EXPECT_TRUE(verdict(8.9).passed.empty());
}

TEST_F(Beams, DoNotSpeakWhereTheTurnBlursThem) {
  EXPECT_FALSE(verdict(8.0).passed.empty());
  turn_rate = 3.0;
  EXPECT_TRUE(verdict(8.0).passed.empty());
}

}  // namespace
}  // namespace deltamap::mapping::votes
