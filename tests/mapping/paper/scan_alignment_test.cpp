// SPDX-License-Identifier: Apache-2.0
#include "mapping/paper/scan_alignment.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "mapping/paper/local_map.hpp"
#include "mapping/registration/acceptance.hpp"
#include "mapping/registration/contour_score.hpp"
#include "tests/support/scans/kept_scans.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::paper {
namespace {

TEST(ScanMatch, FindsTheMotionBetweenTwoScansWithinItsCovariance) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{1};
  double chi2_sum = 0.0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Pose2 first{random.uniform(6.5, 7.5), random.uniform(6.0, 7.5), random.uniform(-3.0, 3.0)};
    const Pose2 second = test::disturbed(first, 0.4, 0.2, random);
    const ScanMatchingParams params;
    const TrackedScan from = test::seen_scan(hall, first, 0.01, random);
    const TrackedScan to = test::seen_scan(hall, second, 0.01, random);
    const Pose2 guess = test::disturbed(motion_between(first, second), 0.1, 0.03, random);
    const auto match = scan_match(matchable(from, params), matchable(to, params), guess, params);
    ASSERT_TRUE(match) << trial;
    const Pose2 truth = motion_between(first, second);
    const Eigen::Vector3d error{match->first_from_second.x - truth.x, match->first_from_second.y - truth.y,
                                turn_between(truth.theta, match->first_from_second.theta)};
    EXPECT_LT(error.head<2>().norm(), 0.04) << trial;
    EXPECT_LT(std::abs(error.z()), radians(0.4)) << trial;
    chi2_sum += error.dot(match->covariance.inverse() * error);
  }
  EXPECT_LT(chi2_sum / kTrials, 6.0) << "the covariance claims more than is true (3 expected)";
  EXPECT_GT(chi2_sum / kTrials, 0.3) << "the covariance claims nothing";
}

TEST(ScanMatch, LeavesTheLengthOfACorridorUnobserved) {
  OccupancyGrid corridor{{2000, 150, 0.02, {0.0, 0.0}}};
  test::fill(corridor, {0.0, 0.46}, {40.0, 0.5}, CellState::kOccupied);
  test::fill(corridor, {0.0, 2.5}, {40.0, 2.54}, CellState::kOccupied);
  Random random{2};
  const ScanMatchingParams params;
  const auto match = scan_match(matchable(test::seen_scan(corridor, {20.0, 1.5, 0.0}, 0.01, random, 8.0), params),
                                matchable(test::seen_scan(corridor, {20.3, 1.4, 0.0}, 0.01, random, 8.0), params),
                                {0.25, -0.05, 0.02}, params);
  ASSERT_TRUE(match);
  EXPECT_GT(match->covariance(0, 0), 0.3 * 0.3);
  EXPECT_LT(match->covariance(1, 1), 0.02 * 0.02);
  EXPECT_NEAR(match->first_from_second.y, -0.1, 0.02);
  EXPECT_NEAR(match->first_from_second.x, 0.25, 0.25) << "what is not observed stays near where it was";
}

TEST(ScanMatch, HasNoAnswerForScansOfDifferentPlaces) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{3};
  const ScanMatchingParams params;
  const auto first = matchable(test::seen_scan(hall, {1.5, 7.0, 1.6}, 0.01, random), params);
  const auto second = matchable(test::seen_scan(hall, {18.5, 3.0, -0.3}, 0.01, random), params);
  EXPECT_FALSE(scan_match(first, second, {}, params));
  const auto blind = matchable(TrackedScan{}, params);
  EXPECT_FALSE(scan_match(first, blind, {}, params));
  EXPECT_FALSE(scan_match(blind, first, {}, params));
}

/// A drive through the hall; the localizer errs by a few centimetres, odometry drifts.
std::vector<TrackedScan> drive(const OccupancyGrid& hall, std::vector<Pose2>* truth, Random& random) {
  std::vector<TrackedScan> scans;
  Pose2 odom;
  for (int i = 0; i < 25; ++i) {
    const Pose2 pose{4.0 + 0.35 * i, 7.0 + 0.3 * std::sin(0.4 * i), 0.3 * std::cos(0.4 * i)};
    if (!truth->empty()) {
      const Pose2 motion = motion_between(truth->back(), pose);
      odom = odom * Pose2{1.02 * motion.x, motion.y, motion.theta + 0.01};
    }
    truth->push_back(pose);
    TrackedScan scan = test::seen_scan(hall, pose, 0.01, random);
    scan.estimate.map_from_robot = i == 0 ? pose : test::disturbed(pose, 0.05, 0.02, random);
    scan.estimate.covariance = Eigen::Vector3d{0.0025, 0.0025, 0.0004}.asDiagonal();
    scan.odom_from_robot = odom;
    scans.push_back(std::move(scan));
  }
  return scans;
}

TEST(ScanAlignment, BringsScansTogetherBetterThanTheLocalizerHadThem) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{4};
  std::vector<Pose2> truth;
  const std::vector<TrackedScan> scans = drive(hall, &truth, random);
  const auto alignment = scan_alignment(test::kept(scans), {});
  ASSERT_TRUE(alignment);
  ASSERT_EQ(alignment->scans.size(), scans.size());
  EXPECT_GE(alignment->matches, 2 * scans.size());
  // Relative to the first pose, which holds the network.
  const Pose2 truth_from_aligned = truth[0] * inverse(alignment->map_from_robot[0]);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    before += distance_between(scans[i].estimate.map_from_robot, truth[i]);
    after += distance_between(truth_from_aligned * alignment->map_from_robot[i], truth[i]);
  }
  EXPECT_LT(after / static_cast<double>(scans.size()), 0.03);
  EXPECT_LT(after, 0.5 * before);
}

TEST(ScanAlignment, ThinsTooManyScansEvenly) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{5};
  std::vector<Pose2> truth;
  const std::vector<TrackedScan> scans = drive(hall, &truth, random);
  ScanAlignmentParams params;
  params.most_scans = 9;
  const auto alignment = scan_alignment(test::kept(scans), params);
  ASSERT_TRUE(alignment);
  EXPECT_EQ(alignment->scans, (std::vector<std::size_t>{0, 3, 6, 9, 12, 15, 18, 21, 24}));
}

/// Two rooms of one phase, joined by nothing but a long way on odometry that turned the second one round.
TEST(ScanAlignment, LeavesOutScansThatOnlyAPoorOdometryHolds) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{8};
  std::vector<TrackedScan> scans;
  for (int i = 0; i < 10; ++i) {
    const bool is_apart = i >= 7;
    const Pose2 pose = is_apart ? Pose2{18.0, 2.0 + 0.2 * (i - 7), 0.2} : Pose2{1.5 + 0.2 * i, 7.0, 2.0};
    scans.push_back(test::seen_scan(hall, pose, 0.01, random, 6.0));
    scans.back().odom_from_robot = is_apart ? Pose2{0.0, 0.0, 0.6} * pose : pose;
  }
  const auto alignment = scan_alignment(test::kept(scans), {});
  ASSERT_TRUE(alignment);
  EXPECT_EQ(alignment->scans, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(alignment->map_from_robot.size(), 7U);
  EXPECT_EQ(alignment->covariances.size(), 7U);
}

TEST(ScanAlignment, HasNoAnswerForScansThatDoNotOverlap) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{6};
  std::vector<TrackedScan> scans;
  for (int i = 0; i < 6; ++i) {
    scans.push_back(test::seen_scan(hall, {1.0 + 3.5 * i, 7.0, 2.0 * i}, 0.01, random));
    for (auto& ray : scans.back().rays) ray.end *= 1.0F + 0.5F * static_cast<float>(random.uniform());
  }
  EXPECT_FALSE(scan_alignment(test::kept(scans), {}));
  EXPECT_FALSE(scan_alignment({}, {}));
}

TEST(LocalMap, DrawsWhatTheScansSawOnTheMapsLattice) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  Random random{7};
  std::vector<TrackedScan> scans;
  for (int i = 0; i < 24; ++i) scans.push_back(test::seen_scan(hall, {7.0 + 0.03 * i, 6.6, 0.27 * i}, 0.002, random));
  std::vector<const TrackedScan*> pointers;
  std::vector<Pose2> poses;
  for (const TrackedScan& scan : scans) {
    pointers.push_back(&scan);
    poses.push_back(scan.estimate.map_from_robot);
  }
  const OccupancyGrid local = local_map(pointers, poses, hall.geometry(), {});
  const double columns = (local.geometry().origin.x() - hall.geometry().origin.x()) / 0.05;
  EXPECT_NEAR(columns, std::round(columns), 1e-9);
  EXPECT_GT(registration::acceptance(local, hall).value(), 0.97);
  EXPECT_GT(registration::surface_agreement(hall, local, {}), 0.99);
}

TEST(LocalMap, FreesNothingAlongBeamsWithoutRange) {
  TrackedScan blind;
  blind.scan.beams.assign(3, Beam{0.0F, 0.0F, BeamKind::kBeyondMaximum});
  blind.rays.assign(3, RayInRobot{{0.0F, 0.0F}, {5.0F, 0.0F}});
  const TrackedScan* scan = &blind;
  const Pose2 pose;
  const OccupancyGrid local = local_map({&scan, 1}, {&pose, 1}, {10, 10, 0.1, {0.0, 0.0}}, {});
  EXPECT_EQ(count_of(local, CellState::kFree), 0U);
}

}  // namespace
}  // namespace deltamap::mapping::paper
