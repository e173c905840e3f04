// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/reference_score.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::simulation::score {
namespace {

StampedPose at(double time_s, double x, double y = 0.0, double theta = 0.0) {
  return {Timestamp{duration_from_seconds(time_s)}, {x, y, theta}};
}

TEST(ReferenceScore, TakesErrorsOfMatchedPosesAndCountsMissingOnesAsLost) {
  const std::vector<StampedPose> reference{at(0, 0), at(1, 1), at(2, 2), at(3, 3), at(4, 4)};
  const ReferenceScore score = reference_score({at(0.04, 0.3), at(1, 1, 0.4, 0.1), at(2, 3), at(10, 4)}, reference);
  EXPECT_EQ(score.matched, 3u);
  EXPECT_EQ(score.of, 5u);
  EXPECT_NEAR(score.rmse_m, std::sqrt((0.09 + 0.16 + 1.0) / 3.0), 1e-12);
  EXPECT_NEAR(score.median_m, 0.4, 1e-12);
  EXPECT_NEAR(score.max_m, 1.0, 1e-12);
  EXPECT_NEAR(score.p95_heading_rad, 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(score.coverage, 0.6);
  EXPECT_DOUBLE_EQ(score.lost_share, 0.6);
  EXPECT_DOUBLE_EQ(score.longest_lost_s, 2.0);
}

TEST(ReferenceScore, LosesNothingWhereTheReferenceIsDenserThanTheScans) {
  std::vector<StampedPose> reference;
  for (int i = 0; i <= 400; ++i) reference.push_back(at(0.01 * i, 0.004 * i));
  std::vector<StampedPose> scans;
  for (int i = 0; i <= 20; ++i) scans.push_back(at(0.2 * i, 0.08 * i));
  const ReferenceScore perfect = reference_score(scans, reference);
  EXPECT_DOUBLE_EQ(perfect.coverage, 1.0);
  EXPECT_DOUBLE_EQ(perfect.lost_share, 0.0);
  EXPECT_DOUBLE_EQ(perfect.longest_lost_s, 0.0);
  for (std::size_t i = 0; i < scans.size(); ++i) scans[i].map_from_robot.y = i < 10 ? 1.0 : 0.0;
  EXPECT_NEAR(reference_score(scans, reference).lost_share, 0.475, 0.01) << "up to the middle of two scans";
  scans.erase(scans.begin() + 5, scans.begin() + 15);
  const ReferenceScore cut = reference_score(scans, reference);
  EXPECT_NEAR(cut.coverage, 1.0 - (2.2 - 2 * 0.15) / 4.0, 0.01) << "where scans are missing there is no estimate";
}

TEST(ReferenceScore, OfAPartOfADriveLosesNothingOfTheRest) {
  const std::vector<StampedPose> reference{at(0, 0), at(1, 1), at(2, 2), at(3, 3), at(4, 4)};
  const std::vector<StampedPose> part{at(1.04, 1), at(2, 2), at(2.97, 3)};
  EXPECT_DOUBLE_EQ(reference_score(part, reference).lost_share, 0.4);
  EXPECT_EQ(reference_within(part, reference).size(), 3u);
  EXPECT_DOUBLE_EQ(reference_score(part, reference_within(part, reference)).lost_share, 0.0);
  EXPECT_TRUE(reference_within({at(9, 0)}, reference).empty());
  EXPECT_TRUE(reference_within({}, reference).empty());
}

TEST(ReferenceScore, IsOfNoPoseWhereTheTimesDoNotMeet) {
  EXPECT_EQ(reference_score({at(100, 0)}, {at(0, 0)}).matched, 0u);
}

TEST(ReferenceScore, ComparesTheLaserWhereTheReferenceIsOfIt) {
  const Pose2 robot_from_laser{0.25, 0.0, 0.0};
  const std::vector<StampedPose> of_laser = laser_poses({at(0, 1, 1, radians(90.0))}, robot_from_laser);
  EXPECT_NEAR(reference_score(of_laser, {at(0, 1, 1.25, radians(90.0))}).rmse_m, 0.0, 1e-12);
}

TEST(Reference, IsReadOfPlainPosesAndOfTumInOrderOfTime) {
  const test::TemporaryFolder folder;
  const auto poses = read_reference(folder.write("ref.txt", "# t x y theta\n2 5 6 0.5\n1 3 4 0 0 0 1 0\n"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].map_from_robot.x, 3.0);
  EXPECT_NEAR(std::abs(poses[0].map_from_robot.theta), radians(180.0), 1e-9);
  EXPECT_EQ(poses[1].map_from_robot.theta, 0.5);
}

TEST(Reference, ThatIsNoneIsNamedWithItsLine) {
  const test::TemporaryFolder folder;
  for (const char* wrong : {"1 2 3\n", "1 2 3 x\n", "1 2 3 nan\n", "1 2 3 4 5 6 7 8 9\n"}) {
    const auto file = folder.write("wrong.txt", std::string{"0 0 0 0\n"} + wrong);
    try {
      (void)read_reference(file);
      ADD_FAILURE() << wrong;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string{error.what()}.find("wrong.txt: line 2: not a pose"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace deltamap::simulation::score
