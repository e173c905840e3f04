// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/particle_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/support/scans/cast_ends.hpp"

namespace deltamap::localization::particles {
namespace {

OccupancyGrid room() {
  OccupancyGrid map{{120, 80, 0.05, {0.0, 0.0}}, CellState::kOccupied};
  test::fill_box(map, {0.2, 0.2}, {5.8, 3.8}, CellState::kFree);
  test::fill_box(map, {4.0, 1.0}, {4.6, 1.4}, CellState::kOccupied);
  return map;
}

PoseCovariance spread(double position_deviation_m, double heading_deviation_rad) {
  const double position_m2 = position_deviation_m * position_deviation_m;
  return motion::covariance_along(0.0, position_m2, position_m2, heading_deviation_rad * heading_deviation_rad);
}

/// Of particles with equal weights.
PoseCovariance covariance_of(const ParticleSet& particles, const Pose2& mean) {
  PoseCovariance sum = PoseCovariance::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Eigen::Vector3d off{particles.x_m[i] - mean.x, particles.y_m[i] - mean.y,
                              wrapped_angle(particles.heading_rad[i] - mean.theta)};
    sum += off * off.transpose();
  }
  return sum / static_cast<double>(particles.size());
}

TEST(ParticleFilter, StartsAsACovarianceHasIt) {
  ParticleFilter filter{{}, 1};
  PoseCovariance aslant = spread(0.5, 0.05);
  aslant(1, 2) = aslant(2, 1) = 0.9 * 0.5 * 0.05;  // a robot that has turned too far is off to the left
  aslant(0, 0) = 0.0;                              // and knows exactly how far it has come
  filter.start_around({2.0, 1.0, 0.3}, aslant, 4000);
  const PoseCovariance found = covariance_of(filter.particles(), {2.0, 1.0, 0.3});
  EXPECT_NEAR(found(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(found(1, 1), 0.25, 0.02);
  EXPECT_NEAR(found(1, 2) / std::sqrt(found(1, 1) * found(2, 2)), 0.9, 0.02);
}

TEST(ParticleFilter, WeighsProposedPosesByTheirPriorAndByTheScan) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  const Pose2 truth{2.0, 2.0, 0.5};
  const Pose2 elsewhere{1.2, 1.0, -0.5};
  const auto weight_of_first = [&](double log_prior) {
    ParticleFilter filter{{.min = 10, .max = 10}, 1};
    filter.start_around(elsewhere, spread(0.01, 0.01), 10);
    const std::vector<sensor::ProposedPose> poses{{truth, log_prior}, {elsewhere, 0.0}};
    filter.propose(poses);
    EXPECT_EQ(filter.particles().pose(0), truth);
    EXPECT_EQ(filter.particles().pose(1), elsewhere);
    (void)filter.weigh(field, test::cast_ends(map, truth));
    return filter.particles().weight[0];
  };
  EXPECT_GT(weight_of_first(0.0), 0.9) << "the scan tells where it is";
  EXPECT_LT(weight_of_first(-100.0), 0.01) << "but the wheels exclude it";
}

TEST(ParticleFilter, TakesNoMoreProposalsThanItHasParticles) {
  ParticleFilter filter{{.min = 10, .max = 10}, 1};
  filter.start_around({1.0, 1.0, 0.0}, spread(0.1, 0.1), 10);
  filter.propose(std::vector<sensor::ProposedPose>(20, {{2.0, 1.0, 0.0}, 0.0}));
  EXPECT_EQ(filter.particles().size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(filter.particles().pose(i), (Pose2{2.0, 1.0, 0.0}));
}

TEST(ParticleFilter, StartsAroundAPose) {
  ParticleFilter filter{{.min = 4000, .max = 5000}, 1};
  filter.start_around({2.0, 1.0, 3.1}, spread(0.2, 0.1), 4000);
  const ParticleSet& particles = filter.particles();
  ASSERT_EQ(particles.size(), 4000u);
  EXPECT_NEAR(std::accumulate(particles.x_m.begin(), particles.x_m.end(), 0.0) / 4000.0, 2.0, 0.02);
  for (const double heading_rad : particles.heading_rad) EXPECT_LE(std::abs(heading_rad), std::numbers::pi);
  EXPECT_NEAR(filter.n_eff(), 4000.0, 1e-6);
}

TEST(ParticleFilter, AccumulatesWeightsUntilItResamples) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 300, .max = 300, .resample_below = 0.0, .evidence_beams = 5.0}, 1};
  filter.start_around({2.0, 2.0, 0.5}, spread(0.2, 0.1), 300);
  const motion::BeamEnds ends = test::cast_ends(map, {2.0, 2.0, 0.5});
  double last = filter.n_eff();
  for (int i = 0; i < 4; ++i) {
    (void)filter.weigh(field, ends);
    EXPECT_LT(filter.n_eff(), last);
    last = filter.n_eff();
    const auto& weights = filter.particles().weight;
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-9);
    EXPECT_FALSE(filter.resample_if_needed(10));
  }
}

TEST(ParticleFilter, ResamplesToEqualWeightsAndAsManyAsTheCellsCallFor) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 100, .max = 2000, .resample_below = 1.0}, 1};
  filter.start_around({2.0, 2.0, 0.5}, spread(0.2, 0.1), 100);
  (void)filter.weigh(field, test::cast_ends(map, {2.0, 2.0, 0.5}));
  EXPECT_TRUE(filter.resample_if_needed(60));
  EXPECT_GT(filter.particles().size(), 800u);
  EXPECT_LE(filter.particles().size(), 2000u);
  EXPECT_NEAR(filter.n_eff(), static_cast<double>(filter.particles().size()), 1e-6);
  (void)filter.weigh(field, test::cast_ends(map, {2.0, 2.0, 0.5}));
  EXPECT_TRUE(filter.resample_if_needed(1));
  EXPECT_EQ(filter.particles().size(), 100u);
}

std::size_t heaviest(const ParticleFilter& filter) {
  const std::vector<double>& weights = filter.particles().weight;
  return static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

TEST(ParticleFilter, BelievesAProposedSlipThatFitsFarBetterThanWhatTheWheelsTell) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  const Pose2 truth{2.0, 2.0, 0.5};
  const motion::BeamEnds ends = test::cast_ends(map, truth);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ParticleFilter filter{{.min = 500, .max = 500, .evidence_beams = 60.0}, seed};
    filter.start_around({1.8, 2.0, 0.6}, spread(0.005, 0.002), 500);
    filter.move({}, 0.0, {});
    filter.propose_slips(std::vector<Pose2>{{1.7, 2.0, 0.7}, truth});
    (void)filter.weigh(field, ends);
    EXPECT_TRUE(filter.best_has_slipped());
    EXPECT_LT(distance_between(filter.particles().pose(heaviest(filter)), truth), 0.06);
  }
}

TEST(ParticleFilter, HasNotSlippedWhereTheWheelsAreRightOrSlipsAreNeverBelieved) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  const Pose2 truth{2.0, 2.0, 0.5};
  const motion::BeamEnds ends = test::cast_ends(map, truth);
  const auto has_slipped = [&](const Pose2& start, const motion::MotionModelParams& motion) {
    ParticleFilter filter{{.min = 500, .max = 500, .evidence_beams = 60.0}, 1};
    filter.start_around(start, spread(0.005, 0.002), 500);
    filter.move({}, 0.0, motion);
    filter.propose_slips(std::vector<Pose2>{truth});
    (void)filter.weigh(field, ends);
    return filter.best_has_slipped();
  };
  EXPECT_FALSE(has_slipped(truth, {}));
  EXPECT_FALSE(has_slipped({1.8, 2.0, 0.6}, {.slip_probability = 0.0}));
  EXPECT_TRUE(has_slipped({1.8, 2.0, 0.6}, {}));
}

TEST(ParticleFilter, KeepsTheBestWhereTheChosenAreSpread) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 500, .max = 500, .evidence_beams = 60.0}, 1};
  filter.start_around({1.9, 2.0, 0.56}, spread(0.1, 0.05), 500);
  (void)filter.weigh(field, test::cast_ends(map, {2.0, 2.0, 0.5}));
  const Pose2 best = filter.particles().pose(heaviest(filter));
  filter.spread_chosen({}, 0.1);
  EXPECT_EQ(filter.particles().pose(0), best);
  EXPECT_NE(filter.particles().pose(1), best);
  EXPECT_EQ(filter.particles().size(), 500u);
}

TEST(ParticleFilter, CountsAScanTheSameWhateverItsNumberOfBeams) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  const motion::BeamEnds all = test::cast_ends(map, {2.0, 2.0, 0.5});
  motion::BeamEnds twice;
  for (std::size_t i = 0; i < 2 * all.size(); ++i) {
    twice.x_m.push_back(all.x_m[i / 2]);
    twice.y_m.push_back(all.y_m[i / 2]);
  }
  ParticleFilter once_filter{{.min = 200, .max = 200, .evidence_beams = 15.0}, 1};
  ParticleFilter twice_filter{{.min = 200, .max = 200, .evidence_beams = 15.0}, 1};
  for (ParticleFilter* filter : {&once_filter, &twice_filter})
    filter->start_around({2.0, 2.0, 0.5}, spread(0.2, 0.1), 200);
  (void)once_filter.weigh(field, all);
  (void)twice_filter.weigh(field, twice);
  EXPECT_NEAR(once_filter.n_eff(), twice_filter.n_eff(), 1e-3);  // the bound is in whole steps
}

/// Share of the weight on the particles near the truth, where as many stand where a moved box would have the robot.
TEST(ParticleFilter, HoldsAMovedThingForOneObservationHoweverManyBeamsMeetIt) {
  OccupancyGrid map{{200, 200, 0.05, {0.0, 0.0}}, CellState::kFree};
  OccupancyGrid world = map;
  for (OccupancyGrid* grid : {&map, &world}) {
    test::fill_box(*grid, {0.0, 9.6}, {10.0, 10.0}, CellState::kOccupied);
    test::fill_box(*grid, {0.0, 0.0}, {0.4, 10.0}, CellState::kOccupied);
  }
  test::fill_box(map, {4.0, 6.6}, {6.0, 7.6}, CellState::kOccupied);
  test::fill_box(world, {4.0, 7.1}, {6.0, 8.1}, CellState::kOccupied);
  const sensor::LikelihoodField field{map, {}};
  const Pose2 truth{5.0, 5.0, std::numbers::pi / 2.0};
  const motion::BeamEnds ends = test::cast_ends(world, truth);
  ParticleFilter filter{{.min = 16, .max = 16, .evidence_beams = 60.0}, 1};
  filter.start_around(truth, PoseCovariance::Zero(), 16);
  filter.move({}, 0.0, {.slip_probability = 1.0 / 16.0});  // one of them, then as likely as each other one
  const std::vector<Pose2> astray{{5.0, 4.5, truth.theta}};
  filter.propose_slips(astray);
  (void)filter.weigh(field, ends);
  const auto [least, most] = std::minmax_element(filter.particles().weight.begin(), filter.particles().weight.end());
  EXPECT_DOUBLE_EQ(filter.particles().pose(static_cast<std::size_t>(least - filter.particles().weight.begin())).y, 4.5);
  EXPECT_LT(*least, 0.05 * *most);
}

TEST(ParticleFilter, KeepsAStandingRobotsParticlesApart) {
  const OccupancyGrid map = room();
  const sensor::LikelihoodField field{map, {}};
  ParticleFilter filter{{.min = 300, .max = 300}, 1};
  filter.start_around({2.0, 2.0, 0.5}, spread(0.1, 0.05), 300);
  const motion::BeamEnds ends = test::cast_ends(map, {2.0, 2.0, 0.5});
  for (int i = 0; i < 300; ++i) {
    filter.move({}, 0.0, {});
    (void)filter.weigh(field, ends);
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
}  // namespace deltamap::localization::particles
