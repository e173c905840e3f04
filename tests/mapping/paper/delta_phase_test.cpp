// SPDX-License-Identifier: Apache-2.0
// The Δ-phases that follow from the divergence ratio, as store-scan sees them.
#include "mapping/paper/delta_phase.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "mapping/paper/divergence_ratio.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/scans/map_requests.hpp"

namespace deltamap::mapping::paper {
namespace {

class PaperPhases : public testing::Test {
 protected:
  PaperPhases() { params.method = MappingMethod::kPaper; }

  /// Sends a scan with that weight.
  std::optional<ScanSet> send(double w_avg, double n_eff = 400.0, LocalizerState state = LocalizerState::kTracking,
                              std::uint32_t epoch = 0) {
    if (!store) store.emplace(params, 1);
    TrackedScan tracked;
    tracked.scan.number = sent++;
    tracked.scan.time = timestamp_from_ns(std::int64_t{sent} * 100'000'000);
    tracked.estimate.w_avg = w_avg;
    tracked.estimate.n_eff = n_eff;
    tracked.estimate.particles = 500;
    tracked.estimate.state = state;
    tracked.estimate.map = std::make_shared<const OccupancyGrid>();
    tracked.odometry_epoch = epoch;
    tracked.weights = ratio.observe(tracked.estimate);
    r_d = tracked.weights.divergence_ratio();
    return test::set_in(store->observe(tracked));
  }
  /// Good scans until the averages agree.
  void settle() {
    for (int i = 0; i < 20; ++i) EXPECT_FALSE(send(0.8));
  }

  StoreScanParams params;
  std::optional<StoreScan> store;
  DivergenceRatio ratio{{.alpha_slow = 0.01, .alpha_fast = 0.5}};
  double r_d = 0.0;
  std::uint32_t sent = 0;
};

TEST_F(PaperPhases, BeginAtTheFirstPositiveRatioAndEndBelowZero) {
  settle();
  EXPECT_FALSE(store->awareness().in_phase);
  EXPECT_TRUE(store->stored().collected.empty());
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(send(0.1));
  EXPECT_TRUE(store->awareness().in_phase);
  EXPECT_EQ(store->stored().collected.size(), store->awareness().stored_scans);
  EXPECT_GT(store->stored().collected.size(), 5u);
  std::optional<ScanSet> set;
  for (int i = 0; i < 20 && !set; ++i) set = send(0.9);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->phase, 1u);
  EXPECT_EQ(set->method, MappingMethod::kPaper);
  EXPECT_FALSE(store->awareness().in_phase);
  EXPECT_LT(r_d, 0.0);
  EXPECT_GT(set->scans.size(), 5u);
  EXPECT_LT(set->began, set->ended);
}

TEST_F(PaperPhases, KeepAScanWithTheProbabilityOfTheRatio) {
  settle();
  int sent_in_phase = 0;
  double expected = 0.0;
  for (; sent_in_phase < 400; ++sent_in_phase) {
    (void)send(0.5);
    expected += std::max(0.0, r_d);
    if (!store->awareness().in_phase) break;
  }
  constexpr double kFourDeviations = 40.0;  // of a sum of 400 draws, at most √(400/4) each
  EXPECT_NEAR(store->awareness().stored_scans, expected, kFourDeviations);
  EXPECT_GT(store->awareness().stored_scans, 20u);
}

TEST_F(PaperPhases, KeepNoScanWhosePoseIsPoor) {
  settle();
  for (int i = 0; i < 50; ++i) (void)send(0.1, 20.0);  // N_eff 20 of 500
  EXPECT_TRUE(store->awareness().in_phase);
  EXPECT_EQ(store->awareness().stored_scans, 0u);
}

TEST_F(PaperPhases, KeepOnlyWhatIsTracked) {
  settle();
  for (int i = 0; i < 50; ++i) (void)send(0.1, 400.0, LocalizerState::kLost);
  EXPECT_FALSE(store->awareness().in_phase);
  EXPECT_EQ(r_d, 0.0);
}

TEST_F(PaperPhases, AreAbandonedWhereTheLocalizerIsLost) {
  settle();
  for (int i = 0; i < 30; ++i) (void)send(0.1);
  EXPECT_GT(store->awareness().stored_scans, 0u);
  EXPECT_FALSE(send(0.1, 400.0, LocalizerState::kLost));
  EXPECT_FALSE(store->awareness().in_phase);
  EXPECT_EQ(store->awareness().stored_scans, 0u);
  EXPECT_FALSE(send(0.1)) << "the ratio is still positive: a new phase begins";
  EXPECT_TRUE(store->awareness().in_phase);
  EXPECT_EQ(store->awareness().phase, 2u);
}

TEST_F(PaperPhases, NeverHoldMoreScansThanTheCap) {
  params.delta_phase.most_scans = 7;
  settle();
  for (int i = 0; i < 200; ++i) (void)send(0.1);
  EXPECT_EQ(store->awareness().stored_scans, 7u);
}

TEST_F(PaperPhases, EndWhereTheOdometryJumps) {
  settle();
  for (int i = 0; i < 50; ++i) (void)send(0.1);
  const auto set = send(0.1, 400.0, LocalizerState::kTracking, 1);
  ASSERT_TRUE(set);
  for (const auto& kept : set->scans) EXPECT_EQ(kept->odometry_epoch, 0u);
}

TEST_F(PaperPhases, DrawTheSameScansFromTheSameSeed) {
  const auto numbers = [&](std::uint64_t seed) {
    store.emplace(params, seed);
    ratio = DivergenceRatio{{.alpha_slow = 0.01, .alpha_fast = 0.5}};
    sent = 0;
    settle();
    for (int i = 0; i < 30; ++i) (void)send(0.5);
    std::optional<ScanSet> set;
    for (int i = 0; i < 20 && !set; ++i) set = send(0.9);
    std::vector<std::uint32_t> kept;
    for (const auto& scan : set->scans) kept.push_back(scan->scan.number);
    return kept;
  };
  const auto once = numbers(1);
  EXPECT_EQ(numbers(1), once);
  EXPECT_NE(numbers(2), once);
}

}  // namespace
}  // namespace deltamap::mapping::paper
