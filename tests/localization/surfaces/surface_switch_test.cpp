// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_switch.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/localization/surfaces/measured_state.hpp"

namespace deltamap::localization::surfaces {
namespace {

Surface face(double x) {
  return {.centre = {x, 0.0},
          .normal = {0.0, 1.0},
          .half_length_m = 0.5,
          .offset_deviation_m = 0.015,
          .turn_deviation_rad = 0.005};
}

/// The offset of a surface measured `offset_m` from where the map has it, with a pose known that well.
double holds_after(double offset_m, double pose_deviation_m) {
  OffsetState state;
  sensor::RefinedPose pose = at_rest(0.0, 0.0, 0.0);
  pose.covariance(1, 1) = pose_deviation_m * pose_deviation_m;
  state.start(pose);
  state.append(0.0, sensor::kMovedM, kMovedRad);
  measure(state, {{{{1, 1.0}, {kOffset, -1.0}}}, 2}, -offset_m, 1e-4);
  measure(state, {{{{2, -1.0}, {kOffset + 1, -1.0}}}, 2}, 0.0, 1e-5);
  std::vector<SurfaceSwitch> switches{{.surface = face(0.0)}};
  settle(switches, state);
  EXPECT_TRUE(state.is_sound());
  return switches[0].holds;
}

TEST(SurfaceSwitch, TellsAMovedSurfaceFromOneThatHolds) {
  EXPECT_GT(holds_after(0.0, 0.01), 0.95);
  EXPECT_GT(holds_after(0.02, 0.01), 0.9);
  EXPECT_LT(holds_after(0.15, 0.01), 0.05);
  EXPECT_LT(holds_after(-0.5, 0.01), 0.01);
  EXPECT_GT(holds_after(0.15, 0.2), 0.5) << "a pose that may be off explains it as well";
}

TEST(SurfaceSwitch, TakesTwoHalvesOfOneFaceForOneObservation) {
  // Pieces of one face, seen 0.1 m off: whether the pose or the face is off, both halves say the same.
  const auto pose_after = [](int pieces) {
    OffsetState state;
    sensor::RefinedPose pose = at_rest(0.0, 0.0, 0.0);
    pose.covariance(1, 1) = 0.06 * 0.06;
    state.start(pose);
    std::vector<SurfaceSwitch> switches;
    for (int i = 0; i < pieces; ++i) {
      state.append(0.0, sensor::kMovedM, kMovedRad);
      switches.push_back({.surface = face(i)});
      const Eigen::Index at = OffsetState::offset_of(static_cast<std::size_t>(i));
      measure(state, {{{{1, 1.0}, {at, -1.0}}}, 2}, -0.1, 1e-4);
      measure(state, {{{{2, -1.0}, {at + 1, -1.0}}}, 2}, 0.0, 1e-5);
    }
    settle(switches, state);
    return switches.front().holds;
  };
  EXPECT_NEAR(pose_after(4), pose_after(1), 0.2);
}

}  // namespace
}  // namespace deltamap::localization::surfaces
