// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/particle_sample.hpp"

namespace deltamap::localization::particles {

std::vector<Pose2> sampled_poses(const ParticleSet& particles, std::size_t most) {
  std::vector<Pose2> poses;
  const std::size_t count = particles.size();
  poses.reserve(count < most ? count : most);
  if (count <= most) {
    for (std::size_t i = 0; i < count; ++i) poses.push_back(particles.pose(i));
    return poses;
  }
  const double step = 1.0 / static_cast<double>(most);
  double next = 0.5 * step;
  double sum = 0.0;
  for (std::size_t i = 0; i < count && poses.size() < most; ++i) {
    sum += particles.weight[i];
    if (sum <= next) continue;
    poses.push_back(particles.pose(i));
    while (next < sum) next += step;
  }
  return poses;
}

}  // namespace deltamap::localization::particles
