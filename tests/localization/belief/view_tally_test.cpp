// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/view_tally.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace deltamap::localization::belief {
namespace {

constexpr double kExact = 1e-9;
const GridGeometry kHall{220, 140, 0.05, {0.0, 0.0}};
constexpr Cell kFace{40, 30};
const Point2 kNorth{0.0, 1.0};
const Point2 kEast{1.0, 0.0};

const Stability kNothingProven{kHall};

std::vector<CheckedBeam> run(BeamFit what, std::size_t beams, const Point2& normal = kNorth) {
  return {beams, {.what = what, .expected = kFace, .normal = normal}};
}

std::vector<CheckedBeam> operator+(std::vector<CheckedBeam> first, const std::vector<CheckedBeam>& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

TEST(ViewTally, KeepsTheTwoDirectionsApart) {
  const std::vector<CheckedBeam> corridor{{BeamFit::kFit, {10, 10}, {0.0, 1.0}},
                                          {BeamFit::kFit, {20, 10}, {0.0, -1.0}},
                                          {BeamFit::kFit, {30, 10}, {0.0, 1.0}},
                                          {BeamFit::kBeyond, {40, 10}, {1.0, 0.0}},
                                          {BeamFit::kSilent, {50, 10}, {1.0, 0.0}}};
  const ViewTally tally = tallied(corridor, kNothingProven);
  EXPECT_EQ(tally.stable.expected, 0u);
  EXPECT_EQ(tally.elsewhere.expected, 4u);
  EXPECT_EQ(tally.elsewhere.beyond, 1u);
  EXPECT_NEAR(tally.elsewhere_along[0].fit, 3.0, 1e-9);
  EXPECT_NEAR(tally.elsewhere_along[0].beyond, 0.0, 1e-9);
  EXPECT_NEAR(tally.elsewhere_along[1].fit, 0.0, 1e-9);
  EXPECT_NEAR(tally.elsewhere_along[1].beyond, 1.0, 1e-9);
}

TEST(ViewTally, CountsABeamWithoutASurfaceInNoDirection) {
  const ViewTally tally = tallied(run(BeamFit::kFit, 3, {0.0, 0.0}), kNothingProven);
  EXPECT_EQ(tally.elsewhere.fit, 3u);
  EXPECT_EQ(tally.elsewhere_along[0].expected() + tally.elsewhere_along[1].expected(), 0.0);
}

TEST(ViewTally, TakesTheDirectionThatMostSurfacesFaceHoweverTheyLie) {
  const double half = std::numbers::sqrt2 / 2.0;
  const ViewTally tally =
      tallied(run(BeamFit::kFit, 4, {half, half}) + run(BeamFit::kFit, 1, {-half, half}), kNothingProven);
  EXPECT_NEAR(tally.elsewhere_along[0].fit, 4.0, kExact);
  EXPECT_NEAR(tally.elsewhere_along[1].fit, 1.0, kExact);
}

TEST(ViewTally, CountsABeamByItsSurfacesShareInEachDirection) {
  const Point2 aslant{0.6, 0.8};
  const ViewTally tally = tallied(
      run(BeamFit::kFit, 50) + run(BeamFit::kShort, 1, aslant) + run(BeamFit::kShort, 1, {-0.6, 0.8}), kNothingProven);
  EXPECT_NEAR(tally.elsewhere_along[0].short_of, 2.0 * 0.64, kExact);
  EXPECT_NEAR(tally.elsewhere_along[1].short_of, 2.0 * 0.36, kExact);
}

TEST(ViewTally, KeepsProvenTilesApart) {
  Stability proven = kNothingProven;
  for (int i = 0; i < 8; ++i) {
    const Timestamp time = timestamp_from_ns(0) + duration_from_seconds(30.0 * (i + 1));
    proven.confirm(kFace, {i % 2 == 0 ? 0.1 : 4.9, 0.2}, time);
  }
  ASSERT_TRUE(proven.proven(kFace));
  std::vector<CheckedBeam> beams = run(BeamFit::kFit, 3);
  beams.push_back({.what = BeamFit::kBeyond, .expected = {100, 100}, .normal = kNorth});
  const ViewTally tally = tallied(beams, proven);
  EXPECT_EQ(tally.stable.fit, 3u);
  EXPECT_EQ(tally.stable.expected, 3u);
  EXPECT_EQ(tally.elsewhere.beyond, 1u);
  EXPECT_EQ(tally.elsewhere.expected, 1u);
  EXPECT_NEAR(tally.stable_along[0].expected(), 3.0, kExact);
  EXPECT_NEAR(tally.elsewhere_along[0].beyond, 1.0, kExact);
}

TEST(ViewTally, CountsNeighboursThatOneThingMisleadsAsAFew) {
  const ViewTally tally = tallied(run(BeamFit::kShort, 30) + run(BeamFit::kFit, 30) + run(BeamFit::kBeyond, 30) +
                                      run(BeamFit::kFit, 1) + run(BeamFit::kShort, 4),
                                  kNothingProven);
  EXPECT_EQ(tally.elsewhere.short_of, 34u);
  EXPECT_NEAR(tally.elsewhere_along[0].fit, 31.0, kExact) << "walls are no accident";
  EXPECT_NEAR(tally.elsewhere_along[0].short_of, 6.0 + 4.0, kExact);
  EXPECT_NEAR(tally.elsewhere_along[0].beyond, 10.0, kExact);
}

TEST(ViewTally, HearsNothingFromSilentBeamsWhichEndARun) {
  const ViewTally tally =
      tallied(run(BeamFit::kShort, 6) + run(BeamFit::kSilent, 1, kEast) + run(BeamFit::kShort, 6), kNothingProven);
  EXPECT_EQ(tally.elsewhere.expected, 12u);
  EXPECT_NEAR(tally.elsewhere_along[0].short_of + tally.elsewhere_along[1].short_of, 12.0, kExact);
}

}  // namespace
}  // namespace deltamap::localization::belief
