// SPDX-License-Identifier: Apache-2.0
#include "localization/beam_model.hpp"

#include <gtest/gtest.h>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/cast_scan.hpp"
#include "tests/support/drawn_flat.hpp"

namespace deltamap::localization {
namespace {

constexpr double kMaxRangeM = 20.0;
const Pose2 kTruth{1.5, 2.0, 0.4};

BeamEnds ends_at(const OccupancyGrid& world, const Pose2& truth) {
  Random random{3};
  const Scan scan = test::cast_scan(world, truth, timestamp_from_ns(0), {.max_range_m = kMaxRangeM}, random);
  return scoring_ends(scan, deskewed(scan, {}), 60);
}

double probability_of_everything(const BeamLikelihood& likelihood, double expected_m) {
  constexpr double kStepM = 1e-4;
  double sum = likelihood.at_maximum();
  for (double range_m = 0.5 * kStepM; range_m < kMaxRangeM; range_m += kStepM) {
    sum += kStepM * likelihood.density(range_m, expected_m);
  }
  return sum;
}

TEST(BeamLikelihood, IsADensityWhereverTheWallIs) {
  const BeamLikelihood likelihood{{}, kMaxRangeM};
  for (const double expected_m : {0.5, 3.0, 12.0, 19.5}) {
    EXPECT_NEAR(probability_of_everything(likelihood, expected_m), 1.0, 0.002) << expected_m;
  }
}

TEST(BeamLikelihood, ForgivesWhatStandsInFrontOfAWallMoreThanWhatLiesBehindIt) {
  const BeamLikelihood likelihood{{}, kMaxRangeM};
  EXPECT_GT(likelihood.density(3.0, 8.0), 3.0 * likelihood.density(13.0, 8.0));
  EXPECT_GT(likelihood.density(8.0, 8.0), 20.0 * likelihood.density(3.0, 8.0));
  EXPECT_LT(likelihood.steps(8.0, 8.0), likelihood.steps(3.0, 8.0));
  EXPECT_LT(likelihood.steps(3.0, 8.0), likelihood.steps(13.0, 8.0));
}

TEST(BeamLikelihood, ForgivesLessTheFartherInFront) {
  const BeamLikelihood likelihood{{}, kMaxRangeM};
  EXPECT_GT(likelihood.density(1.0, 15.0), likelihood.density(7.0, 15.0));
}

TEST(BeamModel, ExpectsTheRangeThatTheMapHas) {
  const OccupancyGrid flat = test::drawn_flat();
  const BeamModel model{flat, {}, kMaxRangeM};
  for (double bearing_rad = -3.0; bearing_rad < 3.0; bearing_rad += 0.05) {
    const double cast_m = test::cast_range_m(flat, kTruth, bearing_rad, kMaxRangeM);
    // A slanting beam may pass a corner of a cell between two steps.
    EXPECT_NEAR(model.expected_range_m(kTruth.position(), kTruth.theta + bearing_rad), cast_m, 0.12) << bearing_rad;
  }
}

TEST(BeamModel, EndsBeamsAtTheEdgeOfWhatIsKnown) {
  OccupancyGrid map{{100, 100, 0.1, {0.0, 0.0}}};
  test::fill_box(map, {0.0, 0.0}, {6.0, 10.0}, CellState::kFree);
  const BeamModel model{map, {}, kMaxRangeM};
  EXPECT_NEAR(model.expected_range_m({3.0, 5.0}, 0.0), 3.0, 0.1);
  EXPECT_NEAR(model.expected_range_m({3.0, 5.0}, std::numbers::pi), 3.0, 0.1) << "and at the map's";
  EXPECT_NEAR(model.expected_range_m({9.0, 5.0}, 0.0), 0.0, 0.1) << "and nowhere in the unknown";
}

TEST(BeamModel, FitsBestAtTheTruePose) {
  const OccupancyGrid flat = test::drawn_flat();
  const BeamModel model{flat, {}, kMaxRangeM};
  const BeamEnds ends = ends_at(flat, kTruth);
  const std::int32_t at_truth = model.misfit_steps(ends, {0.0, 0.0}, kTruth);
  for (const Pose2& off : {Pose2{0.2, 0.0, 0.0}, Pose2{-0.2, 0.0, 0.0}, Pose2{0.0, 0.2, 0.0}, Pose2{0.0, -0.2, 0.0},
                           Pose2{0.0, 0.0, 0.1}, Pose2{0.0, 0.0, -0.1}, Pose2{5.0, 1.0, 2.0}}) {
    EXPECT_LT(at_truth, model.misfit_steps(ends, {0.0, 0.0}, kTruth * off))
        << off.x << ' ' << off.y << ' ' << off.theta;
  }
}

TEST(BeamModel, StillFitsBestThereWithSomethingInFront) {
  const OccupancyGrid flat = test::drawn_flat();
  OccupancyGrid changed = flat;
  test::fill_box(changed, {2.2, 2.2}, {2.6, 2.8}, CellState::kOccupied);
  const BeamModel model{flat, {}, kMaxRangeM};
  const BeamEnds ends = ends_at(changed, kTruth);
  const std::int32_t at_truth = model.misfit_steps(ends, {0.0, 0.0}, kTruth);
  for (const Pose2& off : {Pose2{0.2, 0.0, 0.0}, Pose2{-0.2, 0.0, 0.0}, Pose2{0.0, 0.2, 0.0}, Pose2{0.0, -0.2, 0.0}}) {
    EXPECT_LT(at_truth, model.misfit_steps(ends, {0.0, 0.0}, kTruth * off));
  }
}

TEST(BeamModel, KnowsWhereTheLaserSits) {
  const OccupancyGrid flat = test::drawn_flat();
  const BeamModel model{flat, {}, kMaxRangeM};
  Random random{3};
  const Pose2 robot_from_laser{0.3, 0.0, 0.0};
  const Scan scan = test::cast_scan(flat, kTruth, timestamp_from_ns(0),
                                    {.max_range_m = kMaxRangeM, .robot_from_laser = robot_from_laser}, random);
  const BeamEnds ends = scoring_ends(scan, deskewed(scan, {}), 60);
  EXPECT_LT(model.misfit_steps(ends, robot_from_laser.position(), kTruth),
            model.misfit_steps(ends, {0.0, 0.0}, kTruth));
}

TEST(Localizer, FollowsARobotByTheBeamModelToo) {
  const auto flat = std::make_shared<const OccupancyGrid>(test::drawn_flat());
  LocalizerParams params;
  params.model = ScanModel::kBeam;
  params.particles.min = params.particles.max = 100;
  params.beams = 30;
  params.refinement.steps = 0;
  Localizer localizer{params, flat, InitialPose{{1.5, 1.0, 1.2}}, 1};
  Random random{9};
  Pose2 truth{1.5, 1.0, 1.2};
  Pose2 odom;
  for (int step = 0; step < 40; ++step) {
    const Timestamp time = timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(0.1 * step);
    const Pose2 motion{0.06, 0.0, 0.01};
    truth = truth * motion;
    odom = odom * Pose2{1.1 * motion.x, 0.0, motion.theta};
    Odometry odometry;
    odometry.time = time;
    odometry.odom_from_robot = odom;
    localizer.observe(odometry);
    const auto tracked = localizer.observe(test::cast_scan(*flat, truth, time, {.max_range_m = kMaxRangeM}, random));
    if (step < 20) continue;
    EXPECT_LT(distance_between(tracked.estimate.map_from_robot, truth), 0.12) << step;
  }
}

}  // namespace
}  // namespace deltamap::localization
