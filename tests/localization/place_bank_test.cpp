// SPDX-License-Identifier: Apache-2.0
#include "localization/place_bank.hpp"

#include <gtest/gtest.h>

#include "tests/support/drawn_flat.hpp"

namespace deltamap::localization {
namespace {

const Pose2 kTruth{4.5, 2.0, 1.1};

/// Three places beside a believed one, all with the same odds before any scan.
PlaceBank bank_with_three(double log_prior) {
  PlaceBank bank{{}};
  bank.believe(kTruth);
  for (const double y : {1.0, 2.0, 3.0}) bank.admit({.map_from_robot = {1.5, y, 1.1}, .log_prior = log_prior});
  return bank;
}

/// Which of the places were moved by sliding one in turn.
std::vector<bool> slid(PlaceBank& bank) {
  const OccupancyGrid map = test::drawn_flat();
  const LikelihoodField field{map, {}};
  Random random{3};
  const Scan scan = test::cast_scan(map, kTruth, {}, {}, random);
  const std::vector<Place> before{bank.places().begin(), bank.places().end()};
  bank.slide_others(field, scoring_ends(scan, deskewed(scan, {}), 60), 1, 0.0);
  std::vector<bool> moved;
  for (std::size_t i = 0; i < before.size(); ++i) {
    moved.push_back(bank.places()[i].map_from_robot != before[i].map_from_robot);
  }
  return moved;
}

TEST(PlaceBank, SlidesPlacesFarBehindInTurn) {
  PlaceBank bank = bank_with_three(std::log(0.003));
  EXPECT_EQ(slid(bank), (std::vector<bool>{false, true, false, false}));
  EXPECT_EQ(slid(bank), (std::vector<bool>{false, false, true, false}));
}

TEST(PlaceBank, SlidesAtEachScanWhatComesClose) {
  PlaceBank bank = bank_with_three(0.0);
  EXPECT_EQ(slid(bank), (std::vector<bool>{false, true, true, true}));
}

}  // namespace
}  // namespace deltamap::localization
