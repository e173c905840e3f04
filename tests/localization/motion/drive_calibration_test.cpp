// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/drive_calibration.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numbers>
#include <span>

namespace deltamap::localization::motion {
namespace {

constexpr DriveCalibration kLearned{.wheels = {0.01, -0.02, 0.003, 0.04},
                                    .wheel_deviations = {0.001, 0.002, 0.003, 0.004},
                                    .mount_error = {0.005, 0.006, -0.007},
                                    .mount_deviations = {0.008, 0.009, 0.01}};

TEST(DriveCalibration, IsReadAgainAsItWasKept) {
  const std::array<double, 14> numbers = numbers_of(kLearned);
  const auto read = calibration_of(numbers);
  ASSERT_TRUE(read);
  EXPECT_EQ(numbers_of(*read), numbers);
  EXPECT_EQ(read->wheels.turn, kLearned.wheels.turn);
  EXPECT_EQ(read->wheel_deviations.lag_s, kLearned.wheel_deviations.lag_s);
  EXPECT_EQ(read->mount_error, kLearned.mount_error);
}

TEST(DriveCalibration, OfTooFewNumbersOrOfNoneIsRefused) {
  std::array<double, 14> numbers = numbers_of(kLearned);
  EXPECT_FALSE(calibration_of(std::span(numbers).first(13)));
  numbers[12] = -0.001;  // a deviation
  EXPECT_FALSE(calibration_of(numbers));
  numbers[12] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(calibration_of(numbers));
}

TEST(WheelErrors, LengthenTurnAndDelayWhatTheWheelsCounted) {
  const WheelStep step{.motion = {2.0, 0.0, 0.5}, .speed_change_m_per_s = 0.3, .turn_rate_change_rad_per_s = 0.2};
  EXPECT_EQ(corrected(step, {}), step.motion);
  EXPECT_NEAR(corrected(step, {.distance = 0.1}).x, 2.2, 1e-12);
  EXPECT_NEAR(corrected(step, {.turn = 0.1}).theta, 0.55, 1e-12);
  EXPECT_NEAR(corrected(step, {.drift_rad_per_m = 0.01}).theta, 0.52, 1e-12);
  const Pose2 late = corrected(step, {.lag_s = 0.1});
  EXPECT_NEAR(late.theta, 0.52, 1e-12);
  EXPECT_NEAR(late.x, 2.0 * std::cos(0.01) + 0.03, 1e-12);
}

TEST(WheelErrors, TurnTheWayByHalfOfWhatTheHeadingIsTurnedFurther) {
  const Pose2 further = corrected({.motion = {1.0, 0.0, 0.0}}, {.drift_rad_per_m = 0.2});
  EXPECT_NEAR(further.x, std::cos(0.1), 1e-12);
  EXPECT_NEAR(further.y, std::sin(0.1), 1e-12);
  EXPECT_NEAR(further.theta, 0.2, 1e-12);
}

}  // namespace
}  // namespace deltamap::localization::motion
