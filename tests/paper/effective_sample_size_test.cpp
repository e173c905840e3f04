// SPDX-License-Identifier: Apache-2.0
// Figure 6 of the paper: N_eff (Eq. 5) of the localizer while it drives straight, straight past a change, and turns.
#include <gtest/gtest.h>

#include <cstdio>

#include "mapping/paper/delta_phase.hpp"
#include "tests/support/scans/hall_drive.hpp"
#include "tests/support/worlds/changed_hall.hpp"

namespace deltamap::localization {
namespace {

class MeanShare {
 public:
  void operator()(const TrackedScan& tracked) {
    const double share = tracked.estimate.n_eff / tracked.estimate.particles;
    sum_ += share;
    below_gate_ += share < mapping::paper::DeltaPhaseParams{}.least_n_eff_share ? 1 : 0;
    ++count_;
  }
  [[nodiscard]] double value() const { return sum_ / count_; }
  /// Scans that store-scan would not keep (§3.2.1).
  [[nodiscard]] double rejected() const { return static_cast<double>(below_gate_) / count_; }

 private:
  int below_gate_ = 0;
  double sum_ = 0.0;
  int count_ = 0;
};

TEST(Figure6, TurningLowersTheEffectiveSampleSizeAndAChangeDoesNot) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  const OccupancyGrid changed = test::changed_hall();
  MeanShare straight;
  MeanShare past_a_change;
  MeanShare turning;
  LocalizerParams params = test::HallDrive::params();
  params.follow_surfaces = false;  // where surfaces lead the particles rest
  const auto settle = [](const TrackedScan&) {};
  for (const std::uint64_t seed : {41U, 42U, 43U}) {
    test::HallDrive on_known{hall, {1.5, 7.0, 0.0}, seed, params};
    on_known.drive_to({3.0, 7.0}, hall, settle);
    on_known.drive_to({14.0, 7.0}, hall, [&](const TrackedScan& tracked) { straight(tracked); });
    on_known.turn(80, hall, [&](const TrackedScan& tracked) { turning(tracked); });
    test::HallDrive on_changed{hall, {1.5, 7.0, 0.0}, seed, params};
    on_changed.drive_to({3.0, 7.0}, changed, settle);
    on_changed.drive_to({14.0, 7.0}, changed, [&](const TrackedScan& tracked) { past_a_change(tracked); });
  }
  std::printf("N_eff / particles: straight %.3f, straight past a change %.3f, turning %.3f\n", straight.value(),
              past_a_change.value(), turning.value());
  std::printf("rejected by the gate: %.2f, %.2f, %.2f\n", straight.rejected(), past_a_change.rejected(),
              turning.rejected());
  EXPECT_LT(straight.rejected(), 0.1);
  EXPECT_LT(past_a_change.rejected(), 0.3);
  EXPECT_GT(turning.rejected(), 0.6);
  EXPECT_LT(turning.value(), 0.85 * straight.value());
  EXPECT_LT(turning.value(), 0.85 * past_a_change.value());
}

}  // namespace
}  // namespace deltamap::localization
