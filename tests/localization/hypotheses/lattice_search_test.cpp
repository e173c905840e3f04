// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/lattice_search.hpp"

#include <gtest/gtest.h>

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

TEST(LatticeSearch, FindsNothingWhereThereIsNothingToSee) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::CoarseField coarse{map, sensor::LikelihoodField{map, {}}, kBlockM};
  LatticeSearch lattice{kTurns};
  lattice.look(coarse, {}, 1);
  EXPECT_TRUE(lattice.best_apart(1).empty());
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
