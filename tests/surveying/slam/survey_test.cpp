// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/survey.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

PoseCovariance tight() { return Eigen::Vector3d{1e-4, 1e-4, 1e-6}.asDiagonal(); }

/// 1.1 m ahead, a centimetre apart.
Scan two_ends() {
  Scan scan;
  scan.bearing_step_rad = 0.01;
  scan.beams.assign(2, Beam{1.1F, 0.0F, BeamKind::kRange});
  return scan;
}

/// Keyframes of two drives, three each, a metre apart; the second one is not joined.
Survey two_drives() {
  Survey survey;
  survey.component = {0, 1};
  for (std::uint32_t drive = 0; drive < 2; ++drive) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      Keyframe next;
      next.drive = drive;
      next.driven_m = i;
      next.scan = localization::motion::PackedScan{two_ends()};
      next.normals.resize(2);
      survey.add(std::move(next));
      survey.poses.back() = {static_cast<double>(i), 0.0, 0.0};
      const auto node = static_cast<std::uint32_t>(survey.keyframes.size() - 1);
      if (i > 0) survey.add({node - 1, node, {1.0, 0.0, 0.0}, tight(), false});
    }
  }
  return survey;
}

TEST(Survey, MakesAKeyframeOfWhatAScanHasSeen) {
  Random random{1};
  const OccupancyGrid hall = test::drawn_hall(0.05);
  const TrackedScan tracked = test::seen_scan(hall, {1.5, 1.2, 0.0}, 0.01, random);
  const Keyframe made = keyframe(tracked, 2, 7.5);
  EXPECT_EQ(made.ends().size(), 181U);
  ASSERT_EQ(made.normals.size(), 181U);
  EXPECT_GT(std::count_if(made.normals.begin(), made.normals.end(), [](const auto& n) { return n.norm() > 0.99F; }),
            100);
  EXPECT_EQ(made.drive, 2U);
  EXPECT_EQ(made.driven_m, 7.5);
}

TEST(Survey, SolvesEachFrameByItself) {
  Survey survey = two_drives();
  survey.poses[2] = {2.3, 0.1, 0.05};
  survey.poses[5] = {1.8, 0.0, 0.0};
  ASSERT_TRUE(survey.solve());
  for (const std::uint32_t last : {2U, 5U}) {
    EXPECT_LT(distance_between(survey.poses[last], {2.0, 0.0, 0.0}), 1e-3) << last;
  }
}

TEST(Survey, SettlesWithAllItsLinksHoweverManyAreWrong) {
  Survey survey = two_drives();
  for (int i = 0; i < 30; ++i) survey.add({0, 2, {2.6, 0.0, 0.0}, tight(), true});
  ASSERT_TRUE(survey.solve());
  EXPECT_GT(survey.poses[2].x, 2.3) << "they all pull";
  EXPECT_EQ(survey.links.size(), 34U);
}

TEST(Survey, JoinsADriveWhereALinkSays) {
  Survey survey = two_drives();
  survey.join({1, 4, {0.0, 2.0, 1.0}, tight(), true});
  EXPECT_EQ(survey.component_of(3), 0U);
  const Pose2 middle = survey.poses[1] * Pose2{0.0, 2.0, 1.0};
  EXPECT_LT(distance_between(survey.poses[4], middle), 1e-12);
  EXPECT_LT(distance_between(survey.poses[5], middle * Pose2{1.0, 0.0, 0.0}), 1e-12);
  const std::vector<Pose2> before = survey.poses;
  ASSERT_TRUE(survey.solve());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT(distance_between(survey.poses[i], before[i]), 1e-6);
}

TEST(Survey, RemovesLinksAndFindsTheOthersAgain) {
  Survey survey = two_drives();
  survey.add({0, 2, {5.0, 0.0, 0.0}, tight(), true});
  survey.remove(std::array{std::uint32_t{4}});
  ASSERT_EQ(survey.links.size(), 4U);
  for (std::uint32_t node = 0; node < survey.keyframes.size(); ++node) {
    for (const std::uint32_t place : survey.links_of[node]) {
      EXPECT_TRUE(survey.links[place].from == node || survey.links[place].to == node);
    }
  }
  EXPECT_EQ(survey.links_of[0].size(), 1U);
}

TEST(Survey, DrawsASubmapInTheFrameOfAKeyframe) {
  const Survey survey = two_drives();
  const Submap all = submap(survey, 0, 2, 1, 0.0);
  ASSERT_EQ(all.ends.size(), 6U);
  EXPECT_LT((all.ends.front() - Point2{0.1, 0.0}).norm(), 1e-6) << "1.1 m before keyframe 0";
  EXPECT_EQ(submap(survey, 0, 2, 1, 0.5).ends.size(), 3U) << "one in each square";
}

TEST(Survey, FollowsTheWayBackAndOnWithinADrive) {
  const Survey survey = two_drives();
  EXPECT_EQ(back_by(survey, 2, 1.0), 1U);
  EXPECT_EQ(back_by(survey, 5, 9.0), 3U);
  EXPECT_EQ(on_by(survey, 0, 1.5), 1U);
  EXPECT_EQ(on_by(survey, 0, 9.0), 2U);
}

}  // namespace
}  // namespace deltamap::surveying::slam
