// SPDX-License-Identifier: Apache-2.0
// Clusters of particles: those in the same or in neighbouring cells of position and heading belong together. The
// heaviest cluster is the filter's estimate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "localization/particles/particle_set.hpp"

namespace deltamap::localization::particles {

struct ParticleCluster {
  Pose2 map_from_robot;                                ///< weighted mean
  PoseCovariance covariance = PoseCovariance::Zero();  ///< weighted
  double weight = 0.0;                                 ///< share of all particles' weight
};

/// Finds the heaviest cluster; keeps its working memory from scan to scan.
class ParticleClusterFinder {
 public:
  /// The particles must not be empty and their weights sum to 1.
  [[nodiscard]] ParticleCluster best(const ParticleSet& particles);

  /// Of the last answer: indices of the particles that belong to it, rising.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
  /// Of the last answer: how many cells held a particle.
  [[nodiscard]] std::size_t cell_count() const { return cells_.size(); }

 private:
  struct CellOfParticles {
    int column = 0;
    int row = 0;
    int heading = 0;
    std::uint32_t joined = 0;  ///< the cell that speaks for this one
    double weight = 0.0;

    [[nodiscard]] bool holds(int c, int r, int h) const { return column == c && row == r && heading == h; }
  };
  void sort_into_cells(const ParticleSet& particles);
  void join_neighbours();
  [[nodiscard]] std::uint32_t find_or_none(int column, int row, int heading) const;
  [[nodiscard]] std::size_t slot_of(int column, int row, int heading) const;
  [[nodiscard]] std::uint32_t speaker_of(std::uint32_t cell) const;

  std::vector<CellOfParticles> cells_;
  std::vector<std::uint32_t> cell_of_particle_;
  std::vector<std::uint32_t> slots_;  ///< hash table with open addressing: cell + 1, 0 = empty
  std::vector<std::uint32_t> members_;
};

}  // namespace deltamap::localization::particles
