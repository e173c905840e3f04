// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/relation_score.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/files/replace_file.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::simulation::score {
namespace {

Timestamp at_s(double seconds) { return Timestamp{duration_from_seconds(seconds)}; }

/// One metre a second along a circle of 10 m.
Pose2 on_circle(double t_s) {
  const double turned = t_s / 10.0;
  return {10.0 * std::sin(turned), 10.0 - 10.0 * std::cos(turned), wrapped_angle(turned)};
}

std::vector<StampedPose> circle(const Pose2& frame) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 60; ++i) poses.push_back({at_s(i), frame * on_circle(i)});
  return poses;
}

Relation between(double first_s, double second_s, const Pose2& off = {}) {
  return {at_s(first_s), at_s(second_s), motion_between(on_circle(first_s), on_circle(second_s)) * off};
}

TEST(RelationScore, IsNothingForATrajectoryThatAgreesWhateverItsFrame) {
  const RelationScore score =
      relation_score(circle({3.0, -2.0, 2.5}), {between(0, 60), between(10, 20), between(50, 5)});
  EXPECT_EQ(score.relations, 3u);
  EXPECT_EQ(score.outside, 0u);
  EXPECT_NEAR(score.translation_m.mean, 0.0, 1e-9);
  EXPECT_NEAR(score.rotation_rad.mean, 0.0, 1e-9);
}

TEST(RelationScore, TellsMeanAndDeviationOfWhatTheRelationsAreOff) {
  const RelationScore score =
      relation_score(circle({}), {between(0, 10, {0.3, 0.4, 0.0}), between(5, 20, {0.0, 0.1, -0.2})});
  EXPECT_NEAR(score.translation_m.mean, 0.3, 1e-9);
  EXPECT_NEAR(score.translation_m.deviation, 0.2, 1e-9);
  EXPECT_NEAR(score.translation2_m2.mean, 0.13, 1e-9);
  EXPECT_NEAR(score.translation2_m2.deviation, 0.12, 1e-9);
  EXPECT_NEAR(score.rotation_rad.mean, 0.1, 1e-9);
  EXPECT_NEAR(score.rotation2_rad2.mean, 0.02, 1e-9);
}

TEST(RelationScore, FindsPosesBetweenTwoScans) {
  const RelationScore score = relation_score(circle({}), {between(0.5, 30.25)});
  EXPECT_EQ(score.relations, 1u);
  EXPECT_LT(score.translation_m.mean, 0.03) << "a chord in place of an arc";
}

TEST(RelationScore, LeavesOutWhatLiesOutsideOfTheTrajectory) {
  const RelationScore score = relation_score(circle({}), {between(-1, 10), between(50, 61), between(0, 60)});
  EXPECT_EQ(score.relations, 1u);
  EXPECT_EQ(score.outside, 2u);
  EXPECT_EQ(relation_score(circle({}), {between(70, 80)}).relations, 0u);
}

TEST(RelationScore, LeavesOutWhatLiesInAGapOfTheTrajectory) {
  std::vector<StampedPose> with_gap = circle({});
  with_gap.erase(with_gap.begin() + 20, with_gap.begin() + 40);
  const RelationScore score = relation_score(with_gap, {between(10, 30), between(10, 50)});
  EXPECT_EQ(score.relations, 1u);
  EXPECT_EQ(score.outside, 1u);
}

TEST(RelationScore, PutsTheDrivesOfATrajectoryInOrderOfTime) {
  std::vector<StampedPose> later_first = circle({});
  std::rotate(later_first.begin(), later_first.begin() + 30, later_first.end());
  EXPECT_NEAR(relation_score(later_first, {between(10, 50)}).translation_m.mean, 0.0, 1e-9);
}

TEST(ReadRelations, TakesWhatTheAuthorsPublish) {
  const test::TemporaryFolder folder;
  replace_file(folder.path() / "some.relations", "# a comment\n\n10.5 11.5 -0.5 0.25 0 0 0 -1.5\n12 13 1 0 0 0 0 0\n");
  const std::vector<Relation> relations = read_relations(folder.path() / "some.relations");
  ASSERT_EQ(relations.size(), 2u);
  EXPECT_EQ(relations[0].first, at_s(10.5));
  EXPECT_EQ(relations[0].second, at_s(11.5));
  EXPECT_NEAR(relations[0].first_from_second.y, 0.25, 1e-12);
  EXPECT_NEAR(relations[0].first_from_second.theta, -1.5, 1e-12);
}

TEST(ReadRelations, NamesFileAndLineOfWhatIsWrong) {
  const test::TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) -> std::string {
    const auto file = folder.path() / "bad.relations";
    replace_file(file, text);
    try {
      (void)read_relations(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(error_of("1 2 0 0 0 0 0 0\n1 2 0 0\n").find("bad.relations: line 2: not a relation"), std::string::npos);
  EXPECT_NE(error_of("1 2 0 0 0 0 0 nan x\n1 2 x\n").find("line 1: not"), std::string::npos);
  EXPECT_NE(error_of("# nothing\n").find("holds no relation"), std::string::npos);
  EXPECT_THROW((void)read_relations(folder.path()), std::runtime_error);
  EXPECT_THROW((void)read_relations(folder.path() / "none"), std::runtime_error);
}

}  // namespace
}  // namespace deltamap::simulation::score
