// SPDX-License-Identifier: Apache-2.0
// Why not the mean of all particles: between two groups it lies where no particle is. Cells in a hash table, joined
// with their neighbours, find the groups in one pass without being told how many there are.
#include "localization/particles/particle_clusters.hpp"

#include <algorithm>
#include <bit>
#include <numbers>

#include "core/geometry/angle.hpp"

namespace deltamap::localization::particles {
namespace {

constexpr double kCellsPerMetre = 2.0;
constexpr int kHeadings = 24;  // of 15°
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// std::floor without a call, where the processor has no instruction for it (SSE2).
int floored(double value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < towards_zero ? 1 : 0);
}

/// Weighted mean and covariance of some particles. `weight` is what theirs sum to.
ParticleCluster moments(const ParticleSet& particles, std::span<const std::uint32_t> members) {
  ParticleCluster of;
  if (members.empty()) return of;
  const Pose2 first = particles.pose(members.front());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : members) {
    const double w = particles.weight[i];
    const Eigen::Vector3d off = difference(first, particles.pose(i));
    of.weight += w;
    sum += w * off;
    squares.noalias() += w * off * off.transpose();
  }
  if (of.weight <= 0.0) return of;
  const Eigen::Vector3d mean = sum / of.weight;
  of.map_from_robot = {first.x + mean.x(), first.y + mean.y(), wrapped_angle(first.theta + mean.z())};
  of.covariance = squares / of.weight - mean * mean.transpose();
  return of;
}

}  // namespace

std::size_t ParticleClusterFinder::slot_of(int column, int row, int heading) const {
  const auto mixed = static_cast<std::uint32_t>(column) * 0x9E3779B1u ^ static_cast<std::uint32_t>(row) * 0x85EBCA77u ^
                     static_cast<std::uint32_t>(heading) * 0xC2B2AE3Du;
  return (mixed ^ (mixed >> 15)) & (slots_.size() - 1);
}

std::uint32_t ParticleClusterFinder::find_or_none(int column, int row, int heading) const {
  for (std::size_t slot = slot_of(column, row, heading); slots_[slot] != 0; slot = (slot + 1) & (slots_.size() - 1)) {
    if (cells_[slots_[slot] - 1].holds(column, row, heading)) return slots_[slot] - 1;
  }
  return kNone;
}

void ParticleClusterFinder::sort_into_cells(const ParticleSet& particles) {
  cells_.clear();
  cell_of_particle_.resize(particles.size());
  slots_.assign(std::bit_ceil(2 * particles.size() + 1), 0);
  constexpr double kHeadingsPerRad = kHeadings / (2.0 * std::numbers::pi);
  std::uint32_t cell = kNone;  // of the particle before
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const int column = floored(particles.x_m[i] * kCellsPerMetre);
    const int row = floored(particles.y_m[i] * kCellsPerMetre);
    const int heading =
        std::clamp(static_cast<int>((particles.heading_rad[i] + std::numbers::pi) * kHeadingsPerRad), 0, kHeadings - 1);
    if (cell != kNone && cells_[cell].holds(column, row, heading)) {  // neighbours in the list often are in space
      cells_[cell].weight += particles.weight[i];
      cell_of_particle_[i] = cell;
      continue;
    }
    cell = find_or_none(column, row, heading);
    if (cell == kNone) {
      cell = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back({column, row, heading, cell, 0.0});
      std::size_t slot = slot_of(column, row, heading);
      while (slots_[slot] != 0) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = cell + 1;
    }
    cells_[cell].weight += particles.weight[i];
    cell_of_particle_[i] = cell;
  }
}

std::uint32_t ParticleClusterFinder::speaker_of(std::uint32_t cell) const {
  while (cells_[cell].joined != cell) cell = cells_[cell].joined;
  return cell;
}

void ParticleClusterFinder::join_neighbours() {
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    for (int step = 0; step < 27; ++step) {
      const int heading = (cells_[i].heading + step % 3 - 1 + kHeadings) % kHeadings;
      const std::uint32_t other =
          find_or_none(cells_[i].column + step / 9 - 1, cells_[i].row + step / 3 % 3 - 1, heading);
      if (other == kNone || other >= i) continue;  // the later of two cells joins them
      const std::uint32_t a = speaker_of(i);
      const std::uint32_t b = speaker_of(other);
      cells_[std::max(a, b)].joined = std::min(a, b);
    }
  }
}

ParticleCluster ParticleClusterFinder::best(const ParticleSet& particles) {
  sort_into_cells(particles);
  join_neighbours();
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    cells_[i].joined = speaker_of(i);
    if (cells_[i].joined != i) cells_[cells_[i].joined].weight += cells_[i].weight;
  }
  std::uint32_t heaviest = 0;
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].joined == i && cells_[i].weight > cells_[heaviest].weight) heaviest = i;
  }
  members_.clear();
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    if (cells_[cell_of_particle_[i]].joined == heaviest) members_.push_back(i);
  }
  return moments(particles, members_);
}

}  // namespace deltamap::localization::particles
