// SPDX-License-Identifier: Apache-2.0
#include "localization/particle_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/support/cast_scan.hpp"

namespace deltamap::localization {
namespace {

OccupancyGrid room() {
  OccupancyGrid map{{120, 80, 0.05, {0.0, 0.0}}, CellState::kOccupied};
  test::fill_box(map, {0.2, 0.2}, {5.8, 3.8}, CellState::kFree);
  test::fill_box(map, {4.0, 1.0}, {4.6, 1.4}, CellState::kOccupied);
  return map;
}

BeamEnds ends_from(const OccupancyGrid& map, const Pose2& map_from_robot) {
  Random random{4};
  const Scan scan = test::cast_scan(map, map_from_robot, {}, {}, random);
  return scoring_ends(scan, deskewed(scan, {}), 0);
}

TEST(ParticleFilter, StartsAroundAPoseWithTheFewestParticles) {
  ParticleFilter filter{{.min = 4000, .max = 5000}, 1};
  filter.start_around({2.0, 1.0, 3.1}, 0.2, 0.1);
  const ParticleSet& particles = filter.particles();
  ASSERT_EQ(particles.size(), 4000u);
  EXPECT_NEAR(std::accumulate(particles.x_m.begin(), particles.x_m.end(), 0.0) / 4000.0, 2.0, 0.02);
  for (const double heading_rad : particles.heading_rad) EXPECT_LE(std::abs(heading_rad), std::numbers::pi);
  EXPECT_NEAR(filter.n_eff(), 4000.0, 1e-6);
}

TEST(ParticleFilter, AccumulatesWeightsUntilItResamples) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 300, .max = 300, .resample_below = 0.0}, 1};
  filter.start_around({2.0, 2.0, 0.5}, 0.2, 0.1);
  const BeamEnds ends = ends_from(map, {2.0, 2.0, 0.5});
  double last = filter.n_eff();
  for (int i = 0; i < 4; ++i) {
    (void)filter.weigh(field, ends, 5.0);
    EXPECT_LT(filter.n_eff(), last);
    last = filter.n_eff();
    const auto& weights = filter.particles().weight;
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-9);
    EXPECT_FALSE(filter.resample_if_needed(10));
  }
}

TEST(ParticleFilter, ResamplesToEqualWeightsAndAsManyAsTheCellsCallFor) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 100, .max = 2000, .resample_below = 1.0}, 1};
  filter.start_around({2.0, 2.0, 0.5}, 0.2, 0.1);
  (void)filter.weigh(field, ends_from(map, {2.0, 2.0, 0.5}), 20.0);
  EXPECT_TRUE(filter.resample_if_needed(60));
  EXPECT_GT(filter.particles().size(), 800u);
  EXPECT_LE(filter.particles().size(), 2000u);
  EXPECT_NEAR(filter.n_eff(), static_cast<double>(filter.particles().size()), 1e-6);
  (void)filter.weigh(field, ends_from(map, {2.0, 2.0, 0.5}), 20.0);
  EXPECT_TRUE(filter.resample_if_needed(1));
  EXPECT_EQ(filter.particles().size(), 100u);
}

double distance_of_mean_m(const ParticleFilter& filter, const Point2& truth) {
  Point2 mean{0.0, 0.0};
  for (std::size_t i = 0; i < filter.particles().size(); ++i) {
    mean += filter.particles().weight[i] * filter.particles().pose(i).position();
  }
  return (mean - truth).norm();
}

TEST(ParticleFilter, FindsTheRobotAfterASlipFarMoreCloselyWhereAllParticlesSlip) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  const Pose2 truth{2.0, 2.0, 0.5};
  const BeamEnds ends = ends_from(map, truth);
  const MotionModelParams motion;
  double few_m = 0.0;
  double all_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ParticleFilter filter{{.min = 500, .max = 500, .depleted_below = 0.05}, seed};
    filter.start_around({1.8, 2.0, 0.6}, 0.005, 0.002);
    filter.move({}, 0.0, motion);
    (void)filter.weigh(field, ends, 60.0);
    EXPECT_TRUE(filter.rests_on_few_slips());
    few_m += distance_of_mean_m(filter, truth.position());
    filter.let_all_slip(motion);
    (void)filter.weigh(field, ends, 60.0);
    filter.let_chosen_slip(motion, 0.25);
    (void)filter.weigh(field, ends, 60.0);
    all_m += distance_of_mean_m(filter, truth.position());
  }
  EXPECT_LT(all_m, 0.4 * few_m);
  EXPECT_LT(all_m / 20.0, map.resolution_m());
}

TEST(ParticleFilter, KeepsTheBestWhereAllOthersSlip) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 500, .max = 500}, 1};
  filter.start_around({1.9, 2.0, 0.56}, 0.1, 0.05);
  for (const bool again : {false, true}) {
    (void)filter.weigh(field, ends_from(map, {2.0, 2.0, 0.5}), 60.0);
    const std::vector<double>& weights = filter.particles().weight;
    const auto heaviest = std::max_element(weights.begin(), weights.end()) - weights.begin();
    const Pose2 best = filter.particles().pose(static_cast<std::size_t>(heaviest));
    if (again) {
      filter.let_chosen_slip({}, 0.25);
    } else {
      filter.let_all_slip({});
    }
    EXPECT_EQ(filter.particles().pose(0), best);
    EXPECT_NE(filter.particles().pose(1), best);
  }
}

TEST(ParticleFilter, RestsOnFewSlipsOnlyWhereAFewSlipsAreTheBest) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  const BeamEnds ends = ends_from(map, {2.0, 2.0, 0.5});
  const auto rests = [&](const ParticleFilterParams& params, const MotionModelParams& motion, std::uint64_t seed) {
    ParticleFilter filter{params, seed};
    filter.start_around({1.8, 2.0, 0.6}, 0.005, 0.002);
    filter.move({}, 0.0, motion);
    (void)filter.weigh(field, ends, 60.0);
    return filter.rests_on_few_slips();
  };
  const ParticleFilterParams few{.min = 500, .max = 500, .depleted_below = 0.05};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(rests(few, {}, seed));
    EXPECT_FALSE(rests({.min = 500, .max = 500, .depleted_below = 0.0}, {}, seed));
    EXPECT_FALSE(rests(few, {.slip_probability = 0.0}, seed));
  }
  ParticleFilter spread{few, 1};  // far apart and never slipped: few fit, for another reason
  spread.start_around({1.8, 2.0, 0.6}, 0.5, 0.5);
  (void)spread.weigh(field, ends, 60.0);
  EXPECT_LT(spread.n_eff(), 25.0);
  EXPECT_FALSE(spread.rests_on_few_slips());
}

TEST(ParticleFilter, CountsAScanTheSameWhateverItsNumberOfBeams) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  const BeamEnds all = ends_from(map, {2.0, 2.0, 0.5});
  BeamEnds twice = all;
  twice.x_m.insert(twice.x_m.end(), all.x_m.begin(), all.x_m.end());
  twice.y_m.insert(twice.y_m.end(), all.y_m.begin(), all.y_m.end());
  ParticleFilter once_filter{{.min = 200, .max = 200}, 1};
  ParticleFilter twice_filter{{.min = 200, .max = 200}, 1};
  for (ParticleFilter* filter : {&once_filter, &twice_filter}) filter->start_around({2.0, 2.0, 0.5}, 0.2, 0.1);
  (void)once_filter.weigh(field, all, 15.0);
  (void)twice_filter.weigh(field, twice, 15.0);
  EXPECT_NEAR(once_filter.n_eff(), twice_filter.n_eff(), 1e-6);
}

TEST(ParticleFilter, KeepsAStandingRobotsParticlesApart) {
  const OccupancyGrid map = room();
  const LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 300, .max = 300}, 1};
  filter.start_around({2.0, 2.0, 0.5}, 0.1, 0.05);
  const BeamEnds ends = ends_from(map, {2.0, 2.0, 0.5});
  for (int i = 0; i < 300; ++i) {
    filter.move({}, 0.0, {});
    (void)filter.weigh(field, ends, 20.0);
    filter.resample_if_needed(5);
  }
  const auto& x_m = filter.particles().x_m;
  const double mean_m = std::accumulate(x_m.begin(), x_m.end(), 0.0) / 300.0;
  double variance = 0.0;
  for (const double x : x_m) variance += (x - mean_m) * (x - mean_m) / 300.0;
  EXPECT_NEAR(mean_m, 2.0, 0.05);
  EXPECT_GT(std::sqrt(variance), 0.005);
}

}  // namespace
}  // namespace deltamap::localization
