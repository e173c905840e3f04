// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/scan_fit.hpp"

#include <gtest/gtest.h>

#include "localization/motion/deskew.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::localization::odometer {
namespace {

struct Seen {
  SurfelMap map;
  LinePointFinder finder;
  std::span<const LinePoint> points;
};

/// A map that a scan from `mapped` has drawn, and the points of a scan from `seen`; poses of the world.
Seen seen_in(const OccupancyGrid& world, const Pose2& mapped, const Pose2& seen) {
  const test::CastScanner scanner{.max_range_m = 8.0};
  Random random{9};
  Seen answer;
  const Scan first = test::cast_scan(world, mapped, timestamp_from_ns(0), scanner, random);
  answer.map.insert(answer.finder.points_of(first, motion::deskewed(first, {})), mapped);
  answer.map.go_on(0.1, 5.0);
  const Scan second = test::cast_scan(world, seen, timestamp_from_ns(0), scanner, random);
  answer.points = answer.finder.points_of(second, motion::deskewed(second, {}));
  return answer;
}

TEST(ScanFit, FindsThePoseOfAScanFromDecimetresAway) {
  const Pose2 truth{2.1, 3.05, 0.05};
  const Seen seen = seen_in(test::room_with_pillar(), {2.0, 3.0, 0.0}, truth);
  const Pose2 start{2.0, 3.2, -0.05};
  ScanFitter fitter{seen.map, seen.points};
  const Pose2 found = fitter.registered(start, 0.1, {start});
  EXPECT_LT(distance_between(found, truth), 0.03);
  EXPECT_NEAR(found.theta, truth.theta, 0.01);
  EXPECT_GT(fitter.score(found), fitter.score(start));
  const ScanFit fit = fitter.judged(found);
  EXPECT_GT(fit.inliers, 0.8);
  EXPECT_NEAR(fitter.inlier_share(found), fit.inliers, 1e-9);
  EXPECT_LT(fit.covariance(0, 0), 0.03 * 0.03);
  EXPECT_LT(fit.covariance(1, 1), 0.03 * 0.03);
}

TEST(ScanFit, StaysWithThePriorWhereItIsSure) {
  const Pose2 truth{2.1, 3.0, 0.0};
  const Seen seen = seen_in(test::room_with_pillar(), {2.0, 3.0, 0.0}, truth);
  const Pose2 start{2.2, 3.0, 0.0};
  const Eigen::Matrix3d sure = Eigen::Vector3d{1e9, 1e9, 1e9}.asDiagonal();
  EXPECT_LT(distance_between(ScanFitter{seen.map, seen.points}.registered(start, 0.1, {start, sure}), start), 0.005);
}

TEST(ScanFit, KnowsNothingOfTheWayAlongABareCorridor) {
  const Pose2 truth{15.0, 1.0, 0.0};
  const Seen seen = seen_in(test::long_corridor(), truth, truth);
  const ScanFit fit = ScanFitter{seen.map, seen.points}.judged(truth);
  EXPECT_GT(fit.covariance(0, 0), 1.0);
  EXPECT_LT(fit.covariance(1, 1), 0.05 * 0.05);
  EXPECT_LT(fit.covariance(2, 2), 0.02 * 0.02);
}

TEST(ScanFit, OfNothingIsUnknown) {
  const SurfelMap empty;
  const ScanFit fit = ScanFitter{empty, {}}.judged({});
  EXPECT_EQ(fit.lines, 0U);
  EXPECT_EQ(fit.inliers, 0.0);
  EXPECT_GT(fit.covariance(0, 0), 100.0);
}

}  // namespace
}  // namespace deltamap::localization::odometer
