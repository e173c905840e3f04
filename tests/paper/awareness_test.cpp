// SPDX-License-Identifier: Apache-2.0
// Figures 2 to 4 of the paper on a localizer's own weights: w_avg, w_fast, w_slow and r_d with and without a change,
// and the Δ-phases that follow (§3.1–3.2).
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "mapping/paper/divergence_ratio.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/scans/hall_drive.hpp"
#include "tests/support/scans/map_requests.hpp"
#include "tests/support/worlds/changed_hall.hpp"

namespace deltamap::mapping {
namespace {

struct Moment {
  double w_avg = 0.0;
  WeightAverages weights;
  Awareness awareness;
  std::optional<ScanSet> set;
};

/// A lap in the hall that the map knows, then one in `world`; the moments of the second.
std::vector<Moment> second_lap(const OccupancyGrid& world, std::uint64_t seed) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  test::HallDrive drive{hall, {1.5, 1.0, 0.0}, seed};
  StoreScanParams params;
  params.method = MappingMethod::kPaper;
  StoreScan store{params, seed};
  paper::DivergenceRatio ratio{{}};
  std::vector<Moment> moments;
  for (const bool is_second : {false, true}) {
    for (const Point2& place : test::way_round()) {
      drive.drive_to(place, is_second ? world : hall, [&](const TrackedScan& tracked) {
        TrackedScan weighed = tracked;
        weighed.weights = ratio.observe(tracked.estimate);
        Moment moment{tracked.estimate.w_avg, weighed.weights, {}, test::set_in(store.observe(weighed))};
        moment.awareness = store.awareness();
        if (is_second) moments.push_back(std::move(moment));
      });
    }
  }
  return moments;
}

struct Summary {
  double least_w = 1.0;
  double most_r_d = 0.0;
  double positive_share = 0.0;
  std::size_t stored = 0;
};

Summary summary_of(const std::vector<Moment>& moments) {
  Summary summary;
  for (const Moment& moment : moments) {
    summary.least_w = std::min(summary.least_w, moment.w_avg);
    summary.most_r_d = std::max(summary.most_r_d, moment.weights.divergence_ratio());
    summary.positive_share += moment.weights.divergence_ratio() > 0.0 ? 1.0 / static_cast<double>(moments.size()) : 0.0;
    if (moment.set) summary.stored += moment.set->scans.size();
  }
  summary.stored += moments.back().awareness.in_phase ? moments.back().awareness.stored_scans : 0;
  return summary;
}

void print(const char* name, const Summary& s) {
  std::printf("%-10s least w_avg %.3f, most r_d %.3f, r_d > 0 in %.0f %% of scans, %zu scans stored\n", name, s.least_w,
              s.most_r_d, 100.0 * s.positive_share, s.stored);
}

TEST(Figures2To4, TheWeightFallsAndTheRatioRisesWhereTheWorldHasChanged) {
  for (const std::uint64_t seed : {11U, 12U}) {
    const Summary still = summary_of(second_lap(test::drawn_hall(0.05), seed));
    const Summary changed = summary_of(second_lap(test::changed_hall(), seed));
    print("no change", still);
    print("change", changed);
    EXPECT_LT(changed.least_w, 0.7 * still.least_w);
    EXPECT_GT(changed.most_r_d, 2.0 * still.most_r_d);
    EXPECT_GT(changed.stored, 2 * still.stored);
    EXPECT_GT(still.positive_share, 0.1) << "known weakness: the ratio is noisy where nothing has changed";
  }
}

TEST(Figures2To4, PhasesBeginWithTheFirstPositiveRatioAndEndBelowZero) {
  bool was_in_phase = false;
  int began = 0;
  for (const Moment& moment : second_lap(test::changed_hall(), 13)) {
    const Awareness& now = moment.awareness;
    const double r_d = moment.weights.divergence_ratio();
    const bool expected = r_d > 0.0 || (was_in_phase && r_d == 0.0);
    ASSERT_EQ(now.in_phase, expected) << "r_d " << r_d;
    if (moment.set) {
      EXPECT_TRUE(was_in_phase);
      EXPECT_FALSE(moment.set->scans.empty());
    }
    began += now.in_phase && !was_in_phase ? 1 : 0;
    was_in_phase = now.in_phase;
  }
  EXPECT_GE(began, 1);
}

}  // namespace
}  // namespace deltamap::mapping
