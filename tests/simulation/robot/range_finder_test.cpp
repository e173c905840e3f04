// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/range_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulation/robot/perfect_laser.hpp"

namespace deltamap::simulation {
namespace {

const RayCaster& hall() {
  static const RayCaster caster{World{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 0}}}},
                                       {2, ObjectKind::kContainer, Box{{12, 11}, 1, 1, 0}}}}};
  return caster;
}

MovingSurfaces nobody(double) { return {}; }

Sweep same_beam(std::size_t count, double bearing_rad, double step_s) {
  Sweep sweep;
  for (std::size_t i = 0; i < count; ++i) {
    sweep.bearings_rad.push_back(bearing_rad);
    sweep.offsets_s.push_back(static_cast<double>(i) * step_s);
  }
  return sweep;
}

TEST(RangeFinder, CastsEachBeamFromWhereTheRobotIsAtThatMoment) {
  RangeFinder laser{perfect_laser(), Random{1}};
  const auto moving = [](double offset_s) -> Pose2 { return {10.0 - 2.0 * offset_s, 5.0, 0.0}; };
  const auto readings = laser.measure(same_beam(5, 0.0, 0.1), 80.0, hall(), moving, nobody);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(readings[i].range_m, 10.0 + 0.2 * static_cast<double>(i), 1e-9);
}

TEST(RangeFinder, MeasuresFromItsMount) {
  RangeFinderParams params = perfect_laser();
  params.robot_from_laser = {0.25, 0.0, 0.0};
  RangeFinder laser{params, Random{1}};
  const auto readings = laser.measure(
      same_beam(1, 0.0, 0.0), 80.0, hall(),
      [](double) -> Pose2 {
        return {10, 5, 0};
      },
      nobody);
  EXPECT_NEAR(readings[0].range_m, 9.75, 1e-9);
}

TEST(RangeFinder, SaysBeyondMaximumWhereTheModeEnds) {
  RangeFinder laser{perfect_laser(), Random{1}};
  const auto readings = laser.measure(
      same_beam(1, 0.0, 0.0), 8.0, hall(),
      [](double) -> Pose2 {
        return {10, 5, 0};
      },
      nobody);
  EXPECT_EQ(readings[0].kind, BeamKind::kBeyondMaximum);
}

TEST(RangeFinder, HasTheNoiseAndTheDropoutsThatItWasGiven) {
  RangeFinderParams params = perfect_laser();
  params.range_noise_m = 0.02;
  params.dropout_share = 0.1;
  RangeFinder laser{params, Random{2}};
  const auto readings = laser.measure(
      same_beam(20000, 0.0, 0.0), 80.0, hall(),
      [](double) -> Pose2 {
        return {10, 5, 0};
      },
      nobody);
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const Reading& reading : readings) {
    if (reading.kind != BeamKind::kRange) continue;
    sum += reading.range_m - 10.0;
    squares += std::pow(reading.range_m - 10.0, 2);
    count += 1.0;
  }
  EXPECT_NEAR(count / 20000.0, 0.9, 0.01);
  EXPECT_NEAR(sum / count, 0.0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.001);
}

TEST(RangeFinder, BlendsDepthsOnlyAtAnEdge) {
  RangeFinderParams params = perfect_laser();
  params.mixed_share = 1.0;
  RangeFinder laser{params, Random{3}};
  const auto at = [](double) -> Pose2 { return {10, 10.5, 0}; };  // level with the container's lower face, 1.5 m ahead
  int between = 0;
  for (const Reading& reading : laser.measure(same_beam(500, 0.0005, 0.0), 80.0, hall(), at, nobody)) {
    if (reading.range_m > 1.6 && reading.range_m < 9.9) ++between;
  }
  EXPECT_GT(between, 400) << "the beam is split between the container and the wall behind it";
  for (const Reading& reading : laser.measure(same_beam(500, 0.1, 0.0), 80.0, hall(), at, nobody)) {
    EXPECT_NEAR(reading.range_m, 1.5 / std::cos(0.1), 1e-9) << "whole on the face";
  }
}

}  // namespace
}  // namespace deltamap::simulation
