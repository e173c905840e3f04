// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/lattice_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localization/sensor/weighing.hpp"
#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kBlockM = 0.25;
constexpr int kTurns = 48;

motion::BeamEnds ends_seen_from(const Pose2& truth) {
  Random random{3};
  return test::cast_ends(test::drawn_flat(), truth, {}, random, 60);
}

TEST(LatticeSearch, LooksAtEveryPoseOnceHoweverItIsSliced) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlockM};
  const motion::BeamEnds ends = ends_seen_from({4.5, 2.0, 1.1});
  LatticeSearch whole{kTurns, 100};
  whole.look(coarse, ends, whole.poses(coarse));
  LatticeSearch sliced{kTurns, 100};
  for (std::size_t looked_at = 0; looked_at < sliced.poses(coarse); looked_at += 777) sliced.look(coarse, ends, 777);
  const auto expected = whole.best_apart(20);
  const auto found = sliced.best_apart(20);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].map_from_robot, expected[i].map_from_robot);
}

TEST(LatticeSearch, FindsWhatALookAtEachPoseAloneFinds) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField coarse{map, sensor::LikelihoodField{map, {}}, kBlockM};
  const motion::BeamEnds ends = ends_seen_from({4.5, 2.0, 1.1});
  std::vector<std::int32_t> expected;
  for (int turn = 0; turn < kTurns; ++turn) {
    const double heading_rad = wrapped_angle(radians(360.0) * turn / kTurns);
    const sensor::TurnedBeams beams = sensor::turned_beams(ends, heading_rad, kBlockM);
    for (const std::uint32_t block : coarse.free_blocks())
      expected.push_back(sensor::coarse_misfits(coarse, beams, block).front());
  }
  std::sort(expected.begin(), expected.end());
  constexpr std::size_t kKept = 200;
  LatticeSearch lattice{kTurns, kKept};
  lattice.look(coarse, ends, lattice.poses(coarse));
  const std::vector<Candidate> found = lattice.best_apart(kKept);
  ASSERT_GT(found.size(), 5u);
  EXPECT_EQ(found.front().misfit, expected.front());
  EXPECT_LE(found.back().misfit, expected[kKept - 1]);
  LatticeSearch all{kTurns, expected.size()};
  all.look(coarse, ends, all.poses(coarse));
  const std::vector<Candidate> apart = all.best_apart(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].map_from_robot, apart[i].map_from_robot) << i;
}

TEST(LatticeSearch, KnowsWhereAScanMayFitAsWellAsAtTheTruth) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlockM};
  const Pose2 truth{4.5, 2.0, 1.1};
  const motion::BeamEnds ends = ends_seen_from(truth);
  LatticeSearch lattice{kTurns, 2000};
  lattice.look(coarse, ends, lattice.poses(coarse));
  const double fit =
      -sensor::LikelihoodField::kStep * sensor::misfit_steps(field, ends, truth) / static_cast<double>(ends.size());
  const std::vector<Candidate> found = lattice.best_apart(200);
  EXPECT_TRUE(may_reach(found.front(), fit));
  EXPECT_FALSE(may_reach(found.back(), fit));
}

TEST(LatticeSearch, AnswersTheBestFirstEachApartFromThoseBefore) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, kBlockM};
  const Pose2 truth{4.5, 2.0, 1.1};
  LatticeSearch lattice{kTurns, 500};
  lattice.look(coarse, ends_seen_from(truth), lattice.poses(coarse));
  const std::vector<Candidate> found = lattice.best_apart(20);
  ASSERT_GT(found.size(), 5u);
  EXPECT_LT(distance_between(found.front().map_from_robot, truth), 0.4);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GE(found[i].misfit, found[i - 1].misfit);
    for (std::size_t k = 0; k < i; ++k) {
      const Pose2& one = found[i].map_from_robot;
      const Pose2& other = found[k].map_from_robot;
      EXPECT_TRUE(distance_between(one, other) >= 0.5 ||
                  std::abs(turn_between(one.theta, other.theta)) >= radians(15.0))
          << i << ' ' << k;
    }
  }
  EXPECT_TRUE(lattice.best_apart(20).empty()) << "asked for once";
}

TEST(LatticeSearch, KeepsNoMoreThanItWasToldAndThoseTheBest) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField coarse{map, sensor::LikelihoodField{map, {}}, kBlockM};
  const motion::BeamEnds ends = ends_seen_from({4.5, 2.0, 1.1});
  LatticeSearch many{kTurns, 500};
  LatticeSearch one{kTurns, 1};
  many.look(coarse, ends, many.poses(coarse));
  (void)one.look(coarse, ends, one.poses(coarse));
  const std::vector<Candidate> best = one.best_apart(20);
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(best.front().map_from_robot, many.best_apart(1).front().map_from_robot);
}

TEST(LatticeSearch, LooksAtThePosesThatAPriorDoesNotExcludeAndAtNoOther) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField coarse{map, sensor::LikelihoodField{map, {}}, kBlockM};
  const Pose2 truth{4.5, 2.0, 1.1};
  const motion::BeamEnds ends = ends_seen_from(truth);
  PoseCovariance aslant = Eigen::Vector3d{0.25, 0.09, 0.01}.asDiagonal();  // turned too far: off to the left
  aslant(0, 2) = aslant(2, 0) = -0.8 * 0.5 * 0.1;
  const sensor::RefinedPose prior{{4.2, 2.2, 1.1}, aslant};
  LatticeSearch lattice{kTurns, 100000};
  lattice.look_within(coarse, ends, prior);
  const std::vector<Candidate> found = lattice.best_apart(100000);
  ASSERT_FALSE(found.empty());
  const double step_rad = radians(360.0) / kTurns;
  const PoseCovariance of_lattice =
      (Eigen::Vector3d{kBlockM * kBlockM, kBlockM * kBlockM, step_rad * step_rad} / 12.0).asDiagonal();
  const Eigen::Matrix3d information = (aslant + of_lattice).inverse();
  const auto deviations = [&](const Pose2& pose) {
    const Eigen::Vector3d off = difference(prior.map_from_robot, pose);
    return std::sqrt(off.dot(information * off));
  };
  for (const Candidate& candidate : found) EXPECT_LE(deviations(candidate.map_from_robot), 4.0 + 1e-6);

  LatticeSearch whole{kTurns, 100000};
  whole.look(coarse, ends, whole.poses(coarse));
  const std::vector<Candidate> all = whole.best_apart(100000);
  const auto best = std::find_if(
      all.begin(), all.end(), [&](const Candidate& candidate) { return deviations(candidate.map_from_robot) < 4.0; });
  ASSERT_NE(best, all.end());
  EXPECT_EQ(found.front().map_from_robot, best->map_from_robot) << "as a look at the whole map finds it";
}

TEST(LatticeSearch, ALookWithinAPriorStandsBesideTheLookAtTheWholeMap) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField coarse{map, sensor::LikelihoodField{map, {}}, kBlockM};
  const motion::BeamEnds ends = ends_seen_from({4.5, 2.0, 1.1});
  const sensor::RefinedPose prior{{4.2, 2.2, 1.1}, Eigen::Vector3d{0.25, 0.09, 0.01}.asDiagonal()};
  LatticeSearch alone{kTurns, 100};
  alone.look(coarse, ends, 777);
  alone.clear();
  LatticeSearch broken{kTurns, 100};
  broken.look(coarse, ends, 777);
  broken.look_within(coarse, ends, prior);
  broken.clear();
  alone.look(coarse, ends, 777);
  broken.look(coarse, ends, 777);
  EXPECT_EQ(alone.best_apart(1).front().map_from_robot, broken.best_apart(1).front().map_from_robot);
}

TEST(LatticeSearch, FindsNothingWhereThereIsNothingToSee) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField coarse{map, sensor::LikelihoodField{map, {}}, kBlockM};
  LatticeSearch lattice{kTurns};
  lattice.look(coarse, {}, 1);
  lattice.look_within(coarse, {}, {{4.5, 2.0, 1.1}, PoseCovariance::Identity()});
  EXPECT_TRUE(lattice.best_apart(1).empty());
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
