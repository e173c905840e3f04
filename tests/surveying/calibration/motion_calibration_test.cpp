// SPDX-License-Identifier: Apache-2.0
#include "surveying/calibration/motion_calibration.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "localization/motion/motion_model.hpp"

namespace deltamap::surveying::calibration {
namespace {

using localization::motion::motion_noise;
using localization::motion::MotionModelParams;
using localization::motion::MotionNoise;
using localization::motion::sampled_motion;
using localization::motion::turn_drive_turn;
using localization::motion::TurnDriveTurn;

constexpr double kTolerance = 0.2;  // relative: what the command promises

struct Wheels {
  MotionModelParams model{.position_floor_m = 0.0, .heading_floor_rad = 0.0};
  double wheel_scale = 0.0;
  double turn_scale = 0.0;
  double drift_rad_per_m = 0.0;
  double slip_every_m = 0.0;  ///< 0: never
};

struct Drive {
  double metres = 1500.0;
  bool only_straight = false;
  double estimate_position_m = 0.01;
  double estimate_heading_rad = radians(0.2);
};

/// What the wheels should have said, what they did, and the localizer's noisy answer: a drive of straight pieces,
/// arcs and turns on the spot, in steps of 6 cm or 4 degrees.
std::vector<MotionSegment> driven(const Wheels& wheels, const Drive& drive, std::uint64_t seed) {
  Random random{seed};
  MotionSegments segments{{}};
  Pose2 odom;
  const Ziggurat ziggurat;
  Pose2 truth;
  double since_slip_m = 0.0;
  for (double metres = 0.0; metres < drive.metres;) {
    const double kind = drive.only_straight ? 1.0 : random.uniform();
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    for (int i = 0; i < 30; ++i) {
      const Pose2 motion =
          kind < 0.3 ? Pose2{0.0, 0.0, sign * radians(4.0)} : Pose2{0.06, 0.0, kind < 0.6 ? sign * radians(2.0) : 0.0};
      odom = odom * motion;
      const double turn_rad = (1.0 + wheels.turn_scale) * motion.theta + wheels.drift_rad_per_m * motion.x;
      const Pose2 meant{(1.0 + wheels.wheel_scale) * motion.x, 0.0, turn_rad};
      const TurnDriveTurn turns = turn_drive_turn(motion);
      const MotionNoise noise = motion_noise(turns, 0.0, wheels.model);
      truth = sampled_motion(truth, turn_drive_turn(meant), noise, ziggurat, random);
      metres += motion.x + 0.01;
      since_slip_m += motion.x;
      if (wheels.slip_every_m > 0.0 && since_slip_m > wheels.slip_every_m) {
        truth = truth * Pose2{0.4, 0.0, 0.5};
        since_slip_m = 0.0;
      }
      const Pose2 error{random.normal(drive.estimate_position_m), random.normal(drive.estimate_position_m),
                        random.normal(drive.estimate_heading_rad)};
      segments.observe({odom, 0, truth * error, true});
    }
  }
  return segments.segments();
}

void expect_near(const MotionCalibration& found, const MotionModelParams& given) {
  const auto near = [&](MotionSource source, double expected, const char* name) {
    EXPECT_NEAR(found.of(source).value, expected, kTolerance * expected) << name;
  };
  near(MotionSource::kTurnPerTurn, given.turn_per_turn, "turn per turn");
  near(MotionSource::kTurnPerMetre, given.turn_per_metre_rad, "turn per metre");
  near(MotionSource::kMetrePerMetre, given.metre_per_metre, "metre per metre");
  near(MotionSource::kMetrePerTurn, given.metre_per_turn_m, "metre per turn");
}

const Wheels kGood{.model = {.turn_per_turn = 0.1,
                             .turn_per_metre_rad = 0.06,
                             .metre_per_metre = 0.1,
                             .metre_per_turn_m = 0.08,
                             .position_floor_m = 0.0,
                             .heading_floor_rad = 0.0}};
const Wheels kPoor{.model = {.turn_per_turn = 0.3,
                             .turn_per_metre_rad = 0.2,
                             .metre_per_metre = 0.2,
                             .metre_per_turn_m = 0.1,
                             .position_floor_m = 0.0,
                             .heading_floor_rad = 0.0}};

class Calibration : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Calibration, RecoversTheDeviationsThatTheWheelsHave) {
  for (const Wheels& wheels : {kGood, kPoor}) {
    expect_near(fitted_motion(driven(wheels, {}, GetParam()), Systematic::kTakenOut), wheels.model);
  }
}

TEST_P(Calibration, TellsTheScalesFromTheNoise) {
  Wheels wheels = kGood;
  wheels.wheel_scale = 0.03;
  wheels.turn_scale = -0.04;
  wheels.drift_rad_per_m = 0.05;
  const MotionCalibration found = fitted_motion(driven(wheels, {}, GetParam()), Systematic::kTakenOut);
  expect_near(found, wheels.model);
  EXPECT_NEAR(found.wheel_scale.value, wheels.wheel_scale, 0.005);
  EXPECT_NEAR(found.turn_scale.value, wheels.turn_scale, 0.005);
  EXPECT_NEAR(found.drift_rad_per_m.value, wheels.drift_rad_per_m, 0.005);
}

TEST_P(Calibration, IsNotLedAstrayBySlips) {
  Wheels wheels = kGood;
  wheels.slip_every_m = 30.0;
  const MotionCalibration found = fitted_motion(driven(wheels, {}, GetParam()), Systematic::kTakenOut);
  expect_near(found, wheels.model);
  EXPECT_GT(found.outlier_share, 0.01);
}

TEST_P(Calibration, DoesNotTakeTheErrorOfTheEstimateForThatOfTheWheels) {
  const Drive noisy{.estimate_position_m = 0.02, .estimate_heading_rad = radians(0.5)};
  const MotionCalibration found = fitted_motion(driven(kPoor, noisy, GetParam()), Systematic::kTakenOut);
  expect_near(found, kPoor.model);
  EXPECT_NEAR(found.of(MotionSource::kEstimatePosition).value, 0.02, kTolerance * 0.02);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Calibration, testing::Values(1u, 2u, 3u));

TEST(MotionCalibration, CoversTheScalesWhereTheyAreLeftIn) {
  Wheels wheels = kGood;
  wheels.turn_scale = 0.2;
  const auto segments = driven(wheels, {}, 1);
  const MotionCalibration left_in = fitted_motion(segments, Systematic::kLeftIn);
  EXPECT_EQ(left_in.turn_scale.value, 0.0);
  EXPECT_GT(left_in.of(MotionSource::kTurnPerTurn).value,
            1.5 * fitted_motion(segments, Systematic::kTakenOut).of(MotionSource::kTurnPerTurn).value);
}

TEST(MotionCalibration, OwnsUpToWhatItCannotKnow) {
  const MotionCalibration found =
      fitted_motion(driven(kGood, {.metres = 300.0, .only_straight = true}, 1), Systematic::kTakenOut);
  EXPECT_GT(found.of(MotionSource::kTurnPerTurn).error, 0.3 * found.of(MotionSource::kTurnPerTurn).value);
  EXPECT_LT(found.of(MotionSource::kMetrePerMetre).error, 0.3 * found.of(MotionSource::kMetrePerMetre).value);
}

}  // namespace
}  // namespace deltamap::surveying::calibration
