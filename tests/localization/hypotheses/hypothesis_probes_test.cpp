// SPDX-License-Identifier: Apache-2.0
// New hypotheses beside a believed one, from all over the map and from around it.
#include "localization/hypotheses/hypothesis_probes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr int kLatticeHeadings = 48;
const Pose2 kTruePlace{4.5, 2.0, 1.1};

class Probes : public testing::Test {
 protected:
  [[nodiscard]] double fit_at(const Pose2& pose) const { return mean_log_likelihood(field, ends, pose); }
  void look_at_all() { probes.look(coarse, ends, kLatticeHeadings * coarse.free_blocks().size()); }

  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const sensor::CoarseField coarse{map, field, 0.25};
  const motion::BeamEnds ends = test::cast_ends(map, kTruePlace);
  HypothesisProbes probes{kLatticeHeadings, 7};
};

TEST_F(Probes, FindTheTruthAnywhereOnceAllOfTheMapHasBeenLookedAt) {
  look_at_all();
  const std::optional<Pose2> found = probes.best_anywhere(fit_at(kTruePlace));
  ASSERT_TRUE(found);
  EXPECT_LT(distance_between(*found, kTruePlace), 0.4);
  EXPECT_FALSE(probes.best_anywhere(fit_at(kTruePlace))) << "asked since the last look";
}

TEST_F(Probes, FindNothingAnywhereThatCannotFitSoWell) {
  look_at_all();
  EXPECT_FALSE(probes.best_anywhere(10.0)) << "no scan fits so well";
}

TEST_F(Probes, FindABetterPoseAroundTheBelievedOne) {
  const Pose2 believed{kTruePlace.x + 0.4, kTruePlace.y - 0.3, kTruePlace.theta + 0.2};
  const HypothesisProbes::Around around{believed, 0.6, 0.3};
  const std::optional<Pose2> found = probes.best_nearby(field, ends, HypothesisBank{}, around, 300);
  ASSERT_TRUE(found);
  EXPECT_LE(std::abs(found->x - believed.x), 0.6);
  EXPECT_LE(std::abs(found->y - believed.y), 0.6);
  EXPECT_GT(fit_at(*found), fit_at(believed));
  EXPECT_LT(distance_between(*found, kTruePlace), 0.2);
}

TEST_F(Probes, FindNothingAroundThatTheBankKnows) {
  HypothesisBank bank;
  bank.believe(kTruePlace);
  EXPECT_FALSE(probes.best_nearby(field, ends, bank, {kTruePlace, 0.1, 0.05}, 50));
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
