// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/particle_clusters.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/random.hpp"

namespace deltamap::localization::particles {
namespace {

ParticleSet particles_at(const std::vector<Pose2>& poses, const std::vector<double>& weights) {
  ParticleSet particles;
  particles.resize_uniform(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) particles.set_pose(i, poses[i]);
  if (!weights.empty()) particles.weight = weights;
  return particles;
}

TEST(ParticleClusters, TellsTwoPlacesApartAndTakesTheHeavier) {
  ParticleClusterFinder finder;
  const ParticleCluster best = finder.best(
      particles_at({{0.0, 0.0, 0.0}, {10.0, 5.0, 1.0}, {10.2, 5.0, 1.0}, {0.1, 0.0, 0.0}}, {0.3, 0.2, 0.4, 0.1}));
  EXPECT_NEAR(best.weight, 0.6, 1e-12);
  EXPECT_NEAR(best.map_from_robot.x, 10.0 + 0.2 * 0.4 / 0.6, 1e-12);
  ASSERT_EQ(finder.members().size(), 2u);
  EXPECT_EQ(finder.members()[0], 1u);
  EXPECT_EQ(finder.members()[1], 2u);
}

TEST(ParticleClusters, TellsTwoHeadingsAtOnePlaceApart) {
  ParticleClusterFinder finder;
  const ParticleCluster best = finder.best(particles_at({{1.0, 1.0, 0.0}, {1.0, 1.0, 3.0}}, {0.45, 0.55}));
  EXPECT_NEAR(best.map_from_robot.theta, 3.0, 1e-12);
  EXPECT_NEAR(best.weight, 0.55, 1e-12);
}

TEST(ParticleClusters, TakesTheMeanHeadingAcrossTheSeam) {
  ParticleClusterFinder finder;
  const ParticleCluster best = finder.best(particles_at({{0.0, 0.0, 3.1}, {0.0, 0.0, -3.1}}, {}));
  EXPECT_NEAR(best.weight, 1.0, 1e-12);
  EXPECT_NEAR(std::abs(best.map_from_robot.theta), std::numbers::pi, 1e-9);
  EXPECT_NEAR(best.covariance(2, 2), std::pow(std::numbers::pi - 3.1, 2), 1e-9);
}

TEST(ParticleClusters, JoinsAChainOfNeighbours) {
  std::vector<Pose2> chain;
  chain.reserve(40);
  for (int i = 0; i < 40; ++i) chain.push_back({-8.0 + 0.4 * i, 0.3, 0.0});
  ParticleClusterFinder finder;
  const ParticleCluster best = finder.best(particles_at(chain, {}));
  EXPECT_NEAR(best.weight, 1.0, 1e-9);
  EXPECT_EQ(finder.members().size(), chain.size());
}

TEST(ParticleClusters, StatesTheMomentsOfANormalCloud) {
  Random random{9};
  std::vector<Pose2> cloud;
  for (int i = 0; i < 20000; ++i) {
    const double x_m = 4.0 + random.normal(0.1);
    cloud.push_back({x_m, 2.0 + 0.5 * (x_m - 4.0) + random.normal(0.05), random.normal(0.02)});
  }
  ParticleClusterFinder finder;
  const ParticleCluster best = finder.best(particles_at(cloud, {}));
  EXPECT_NEAR(best.map_from_robot.x, 4.0, 0.003);
  EXPECT_NEAR(best.covariance(0, 0), 0.01, 0.0005);
  EXPECT_NEAR(best.covariance(0, 1), 0.005, 0.0005);
  EXPECT_NEAR(best.covariance(1, 1), 0.005, 0.0003);
  EXPECT_NEAR(best.covariance(2, 2), 0.0004, 0.00003);
}

TEST(ParticleClusters, StandsAtTheOnlyParticle) {
  ParticleClusterFinder finder;
  const ParticleCluster best = finder.best(particles_at({{-3.0, 7.0, 2.0}}, {}));
  EXPECT_EQ(best.map_from_robot.x, -3.0);
  EXPECT_EQ(best.covariance, PoseCovariance::Zero());
  EXPECT_EQ(finder.cell_count(), 1u);
}

}  // namespace
}  // namespace deltamap::localization::particles
