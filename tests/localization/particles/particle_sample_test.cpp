// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/particle_sample.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::particles {
namespace {

ParticleSet in_a_row(std::size_t count) {
  ParticleSet particles;
  particles.resize_uniform(count);
  for (std::size_t i = 0; i < count; ++i) particles.set_pose(i, {static_cast<double>(i), 0.0, 0.5});
  return particles;
}

TEST(ParticleSample, HasAllWhereThereAreFew) {
  EXPECT_TRUE(sampled_poses({}, 10).empty());
  const auto poses = sampled_poses(in_a_row(10), 10);
  ASSERT_EQ(poses.size(), 10u);
  EXPECT_EQ(poses[7].x, 7.0);
  EXPECT_EQ(poses[7].theta, 0.5);
}

TEST(ParticleSample, OfEqualWeightsIsEvenlySpread) {
  const auto poses = sampled_poses(in_a_row(1000), 10);
  ASSERT_EQ(poses.size(), 10u);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(poses[i].x, 50.0 + 100.0 * static_cast<double>(i), 1.0);
}

TEST(ParticleSample, FollowsTheWeightsAndNamesAParticleOnce) {
  ParticleSet particles = in_a_row(1000);
  for (std::size_t i = 0; i < 1000; ++i) particles.weight[i] = i < 500 ? 0.0 : 0.25 / 499.0;
  particles.weight[600] = 0.75;
  const auto poses = sampled_poses(particles, 100);
  ASSERT_LE(poses.size(), 100u);
  ASSERT_GE(poses.size(), 25u);
  int heavy = 0;
  for (const Pose2& pose : poses) {
    EXPECT_GE(pose.x, 500.0) << "nothing of what has no weight";
    heavy += pose.x == 600.0 ? 1 : 0;
  }
  EXPECT_EQ(heavy, 1);
}

}  // namespace
}  // namespace deltamap::localization::particles
