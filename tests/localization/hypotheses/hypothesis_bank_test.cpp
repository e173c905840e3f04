// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_bank.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::hypotheses {
namespace {

const Pose2 kTruth{4.5, 2.0, 1.1};

/// Three hypotheses beside a believed one, all with the same odds before any scan.
HypothesisBank bank_with_three(double log_prior) {
  HypothesisBank bank;
  bank.believe(kTruth);
  for (const double y : {1.0, 2.0, 3.0}) bank.admit({.map_from_robot = {1.5, y, 1.1}, .log_prior = log_prior});
  return bank;
}

/// Which of the hypotheses were moved by refining one in turn.
std::vector<bool> refined(HypothesisBank& bank) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  Random random{3};
  const motion::BeamEnds ends = test::cast_ends(map, kTruth, {}, random, 60);
  const std::vector<PoseHypothesis> before{bank.hypotheses().begin(), bank.hypotheses().end()};
  bank.refine_others(field, ends, 1, 0.0);
  std::vector<bool> moved;
  for (std::size_t i = 0; i < before.size(); ++i) {
    moved.push_back(bank.hypotheses()[i].map_from_robot != before[i].map_from_robot);
  }
  return moved;
}

TEST(HypothesisBank, RefinesHypothesesFarBehindInTurn) {
  HypothesisBank bank = bank_with_three(std::log(0.003));
  EXPECT_EQ(refined(bank), (std::vector<bool>{false, true, false, false}));
  EXPECT_EQ(refined(bank), (std::vector<bool>{false, false, true, false}));
}

TEST(HypothesisBank, RefinesAtEachScanWhatComesClose) {
  HypothesisBank bank = bank_with_three(0.0);
  EXPECT_EQ(refined(bank), (std::vector<bool>{false, true, true, true}));
}

/// How far a wrong hypothesis falls behind the believed one by one scan with so many ends.
double falls_behind_by(int beams) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  Random random{3};
  const motion::BeamEnds ends = test::cast_ends(map, kTruth, {}, random, beams);
  const std::vector<float> each_new(ends.size(), 1.0F);
  HypothesisBank bank;
  bank.believe(kTruth);
  bank.admit({.map_from_robot = {1.5, 1.0, 1.1}});
  bank.weigh(field, ends, each_new, 1.0);
  return bank.hypotheses()[0].log_evidence - bank.hypotheses()[1].log_evidence;
}

// A person who stands before the only wall in reach is a handful of ends, not a whole scan.
TEST(HypothesisBank, AFewEndsSayLessThanMany) {
  EXPECT_GT(falls_behind_by(60), 1.0);
  EXPECT_GT(falls_behind_by(6), 0.0);
  EXPECT_NEAR(falls_behind_by(6), 0.1 * falls_behind_by(60), 0.04 * falls_behind_by(60));
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
