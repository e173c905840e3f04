// SPDX-License-Identifier: Apache-2.0
#include "mapping/store_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/random.hpp"
#include "mapping/paper/divergence_ratio.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/scans/map_requests.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping {
namespace {

constexpr double kScanPeriod_s = 0.2;

/// Drives to and fro below the containers of the hall; what the localizer thinks of its pose is told by the test.
class HallWatch {
 public:
  explicit HallWatch(MappingMethod method) : store{{.method = method}, 1} {}

  std::optional<MapRequest> see(const OccupancyGrid& world) {
    TrackedScan tracked = test::drawn_scan(world, map_, test::below_the_containers(time_s_), time_s_, random_);
    time_s_ += kScanPeriod_s;
    tracked.estimate.state = state;
    tracked.estimate.w_avg = w_avg;
    tracked.estimate.belief.other_share = other_share;
    tracked.weights = ratio_.observe(tracked.estimate);
    if (!is_sure) tracked.estimate.covariance *= 2.0;
    return store.observe(tracked);
  }
  /// The first set that ends within the time.
  std::optional<ScanSet> watch(const OccupancyGrid& world, double for_s) {
    std::optional<ScanSet> set;
    for (double left_s = for_s; left_s > 0.0 && !set; left_s -= kScanPeriod_s) set = test::set_in(see(world));
    return set;
  }

  StoreScan store;
  LocalizerState state = LocalizerState::kTracking;
  double w_avg = 0.5;
  double other_share = 0.0;
  bool is_sure = true;

 private:
  std::shared_ptr<const OccupancyGrid> map_ = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  paper::DivergenceRatio ratio_{{}};
  Random random_{5};
  double time_s_ = 0.0;
};

const OccupancyGrid& unchanged_hall() {
  static const OccupancyGrid hall = test::drawn_hall(0.05);
  return hall;
}

const OccupancyGrid& hall_with_a_container() {
  static const OccupancyGrid hall = [] {
    OccupancyGrid grid = test::drawn_hall(0.05);
    test::fill(grid, {9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied);
    return grid;
  }();
  return hall;
}

TEST(StoreScan, AnswersAPapersSetWithTheCovarianceOfThePoseAtItsEnd) {
  HallWatch watch{MappingMethod::kPaper};
  (void)watch.watch(unchanged_hall(), 4.0);
  watch.w_avg = 0.1;
  for (int i = 0; i < 40; ++i) ASSERT_FALSE(watch.see(unchanged_hall()));
  watch.w_avg = 0.9;
  watch.is_sure = false;
  const std::optional<ScanSet> set = watch.watch(unchanged_hall(), 20.0);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->method, MappingMethod::kPaper);
  EXPECT_NEAR(set->covariance(0, 0), 2.0 * 9e-4, 1e-9);
}

std::uint32_t most_short_beams(MappingMethod method, const OccupancyGrid& world) {
  HallWatch watch{method};
  std::uint32_t most = 0;
  for (int i = 0; i < 10; ++i) {
    (void)watch.see(world);
    most = std::max(most, watch.store.awareness().short_beams);
  }
  return most;
}

TEST(StoreScan, CountsBeamsThatContradictTheMapByEvidenceAlone) {
  EXPECT_GT(most_short_beams(MappingMethod::kEvidence, hall_with_a_container()), 10u);
  EXPECT_EQ(most_short_beams(MappingMethod::kEvidence, unchanged_hall()), 0u);
  EXPECT_EQ(most_short_beams(MappingMethod::kPaper, hall_with_a_container()), 0u);
}

TEST(StoreScan, LetsNoScanVoteWhileAnotherPoseFitsAndLetsThoseVoteLate) {
  constexpr double kSoonerThanNewVotes_s = 1.2;  // than EvidencePhaseParams::face_persistence_s
  HallWatch watch{MappingMethod::kEvidence};
  watch.other_share = 0.3;
  EXPECT_FALSE(watch.watch(hall_with_a_container(), 8.0));
  EXPECT_FALSE(watch.store.awareness().in_phase);
  EXPECT_EQ(watch.store.awareness().gate, gate::GateReason::kOtherHypothesis);
  EXPECT_NEAR(watch.store.awareness().gate_shut_for_s, 8.0, 2.0 * kScanPeriod_s);
  watch.other_share = 0.0;
  EXPECT_TRUE(watch.watch(hall_with_a_container(), kSoonerThanNewVotes_s));
  EXPECT_EQ(watch.store.awareness().gate, gate::GateReason::kOpen);
}

TEST(StoreScan, ShowsWhatIsDifferentNowOnlyWhileThePoseIsSure) {
  HallWatch in_order{MappingMethod::kEvidence};
  (void)in_order.watch(unchanged_hall(), 4.0);
  EXPECT_EQ(in_order.store.transients(), nullptr) << "nothing has been different yet";
  HallWatch watch{MappingMethod::kEvidence};
  (void)watch.watch(hall_with_a_container(), 1.2);
  ASSERT_NE(watch.store.transients(), nullptr);
  EXPECT_FALSE(watch.store.transients()->standing.empty());
  watch.other_share = 0.3;
  (void)watch.watch(hall_with_a_container(), 1.0);
  EXPECT_TRUE(watch.store.transients()->standing.empty());
}

TEST(StoreScan, OrdersBackWhatAPoseHasWrittenThatProvesWrong) {
  HallWatch watch{MappingMethod::kEvidence};
  ASSERT_TRUE(watch.watch(hall_with_a_container(), 30.0));
  watch.state = LocalizerState::kLost;
  EXPECT_TRUE(test::is_withdrawal(watch.see(hall_with_a_container())));
  EXPECT_EQ(watch.store.awareness().gate, gate::GateReason::kLost);
  EXPECT_FALSE(watch.see(hall_with_a_container())) << "once";
}

}  // namespace
}  // namespace deltamap::mapping
