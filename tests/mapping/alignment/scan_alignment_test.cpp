// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/scan_alignment.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/kept_scans.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::alignment {
namespace {

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

}  // namespace
}  // namespace deltamap::mapping::alignment
