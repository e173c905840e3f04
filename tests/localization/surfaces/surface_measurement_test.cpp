// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace deltamap::localization::surfaces {
namespace {

constexpr double kNumeric = 1e-4;
constexpr double kStep = 1e-5;
const Surface kWallAhead{.centre = {6.0, 2.0}, .normal = {-1.0, 0.0}, .half_length_m = 3.0};
const Pose2 kBesideIt{2.0, 1.5, 0.4};

/// What the robot sees from `truth` of a wall that stands `offset_m` along its normal and `turn_rad` about its centre.
Sighting sighted(const Surface& surface, const Pose2& truth, double offset_m, double turn_rad, double half_width_m) {
  constexpr int kBeams = 21;
  const Point2 along = surface.tangent();
  std::vector<Point2> ends;
  Sighting sighting;
  sighting.surface = surface;
  sighting.beams = kBeams;
  for (int i = 0; i < kBeams; ++i) {
    const double place_m = 0.5 + half_width_m * (i - kBeams / 2) / (kBeams / 2);
    const Point2 at = surface.centre + place_m * along + (offset_m + turn_rad * place_m) * surface.normal;
    ends.push_back(inverse(truth) * at);
    sighting.mean += ends.back() / kBeams;
  }
  for (const Point2& end : ends) sighting.scatter += (end - sighting.mean) * (end - sighting.mean).transpose();
  return sighting;
}

double coefficient(const SparseRow& row, Eigen::Index index) {
  double sum = 0.0;
  for (const SparseRow::Entry& entry : row.used()) sum += entry.index == index ? entry.value : 0.0;
  return sum;
}

TEST(SurfaceMeasurement, SaysLessWhereRangesErrMore) {
  Sighting sighting = sighted(kWallAhead, kBesideIt, 0.0, 0.0, 1.0);
  const SurfaceMeasurement sharp = measurement_of(sighting, kBesideIt, OffsetState::offset_of(0));
  sighting.range_deviation_m = 0.1;
  const SurfaceMeasurement blunt = measurement_of(sighting, kBesideIt, OffsetState::offset_of(0));
  EXPECT_GT(blunt.distance_variance, sharp.distance_variance + 0.9 * 0.1 * 0.1 / 21.0);
  EXPECT_GT(blunt.turn_variance, sharp.turn_variance);
}

TEST(SurfaceMeasurement, FindsNothingWhereTheWallStandsInItsPlace) {
  const SurfaceMeasurement seen =
      measurement_of(sighted(kWallAhead, kBesideIt, 0.0, 0.0, 1.0), kBesideIt, OffsetState::offset_of(0));
  EXPECT_NEAR(seen.distance_m, 0.0, 1e-9);
  EXPECT_NEAR(seen.turn_rad, 0.0, 1e-9);
  EXPECT_NEAR(seen.along_m, 0.5, 1e-9);
  EXPECT_TRUE(seen.has_turn);
}

TEST(SurfaceMeasurement, IsFarOffWhereTheWallIsExpectedElsewhereThanItStands) {
  const SurfaceStand moved{.offset_m = 0.2, .turn_rad = 0.01, .offset_m2 = 1e-4, .turn_rad2 = 1e-5};
  const SurfaceMeasurement seen = measurement_of(sighted(kWallAhead, kBesideIt, moved.offset_m, moved.turn_rad, 1.0),
                                                 kBesideIt, OffsetState::offset_of(0));
  EXPECT_NEAR(seen.off(moved).offset_m, 0.0, 1e-9);
  EXPECT_NEAR(seen.off(moved).turn_rad, 0.0, 1e-5);
  EXPECT_LT(seen.mahalanobis_squared(moved), 0.01);
  EXPECT_GT(seen.mahalanobis_squared({.offset_m2 = 1e-4, .turn_rad2 = 1e-5}), kInnovationGate);
}

TEST(SurfaceMeasurement, TellsNoTurnWhereTheBeamsLieTooCloseTogether) {
  const SurfaceMeasurement seen =
      measurement_of(sighted(kWallAhead, kBesideIt, 0.0, 0.0, 0.02), kBesideIt, OffsetState::offset_of(0));
  EXPECT_FALSE(seen.has_turn);
  const SurfaceStand turned{.turn_rad = 0.3, .offset_m2 = 1.0, .turn_rad2 = 1e-6};
  EXPECT_LT(seen.mahalanobis_squared(turned), 1.0);
}

TEST(SurfaceMeasurement, MovesWithThePoseAndTheMountAsItsRowsSay) {
  const Sighting sighting = sighted(kWallAhead, kBesideIt, 0.1, 0.02, 1.0);
  const SurfaceMeasurement here = measurement_of(sighting, kBesideIt, OffsetState::offset_of(0));
  const std::vector<Pose2> moved{{kBesideIt.x + kStep, kBesideIt.y, kBesideIt.theta},
                                 {kBesideIt.x, kBesideIt.y + kStep, kBesideIt.theta},
                                 {kBesideIt.x, kBesideIt.y, kBesideIt.theta + kStep}};
  const std::vector<Pose2> mounted{kBesideIt * Pose2{kStep, 0.0, 0.0}, kBesideIt * Pose2{0.0, kStep, 0.0},
                                   kBesideIt * Pose2{0.0, 0.0, kStep}};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto nth = static_cast<std::size_t>(i);
    const SurfaceMeasurement by_pose = measurement_of(sighting, moved[nth], OffsetState::offset_of(0));
    EXPECT_NEAR(coefficient(here.distance, i), (by_pose.distance_m - here.distance_m) / kStep, kNumeric) << i;
    EXPECT_NEAR(coefficient(here.turn, i), (by_pose.turn_rad - here.turn_rad) / kStep, 1e-3) << i;
    const SurfaceMeasurement by_mount = measurement_of(sighting, mounted[nth], OffsetState::offset_of(0));
    EXPECT_NEAR(coefficient(here.distance, OffsetState::kMount + i), (by_mount.distance_m - here.distance_m) / kStep,
                kNumeric)
        << i;
  }
}

TEST(SurfaceMeasurement, IsExplainedByTheOffsetAndTheTurnOfItsOwnSurface) {
  const Eigen::Index offset = OffsetState::offset_of(3);
  const SurfaceMeasurement seen = measurement_of(sighted(kWallAhead, kBesideIt, 0.1, 0.0, 1.0), kBesideIt, offset);
  EXPECT_EQ(coefficient(seen.distance, offset), -1.0);
  EXPECT_NEAR(coefficient(seen.distance, offset + 1), -seen.along_m, 1e-12);
  EXPECT_EQ(coefficient(seen.turn, offset + 1), -1.0);
}

TEST(SurfaceMeasurement, IsSurerByMoreBeamsDownToWhatAllErrTogether) {
  Sighting sighting = sighted(kWallAhead, kBesideIt, 0.0, 0.0, 1.0);
  const double few = measurement_of(sighting, kBesideIt, OffsetState::offset_of(0)).distance_variance;
  sighting.beams = 1e6;
  const double many = measurement_of(sighting, kBesideIt, OffsetState::offset_of(0)).distance_variance;
  EXPECT_LT(many, few);
  EXPECT_NEAR(std::sqrt(many), 0.01, 1e-4);
  sighting.corner_deviation_m = 0.2;
  EXPECT_NEAR(measurement_of(sighting, kBesideIt, OffsetState::offset_of(0)).distance_variance - many, 0.04, 1e-9);
}

}  // namespace
}  // namespace deltamap::localization::surfaces
