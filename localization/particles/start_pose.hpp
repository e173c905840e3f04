// SPDX-License-Identifier: Apache-2.0
// The pose to start from: given by a person and believed, or remembered from the last run and checked against the first
// scans. A pose inside an obstacle or outside the map is moved or refused.
#pragma once

#include <cstdint>
#include <memory>

#include "core/grid/occupancy_grid.hpp"
#include "localization/particles/initial_pose.hpp"
#include "localization/particles/particle_clusters.hpp"

namespace deltamap::localization::particles {

enum class StartKind : std::uint8_t {
  kBelieve,  ///< a person says so
  kCheck,    ///< start there, believe when scans fit
  kAnywhere  ///< nobody could be there
};

struct Start {
  StartKind kind = StartKind::kBelieve;
  InitialPose pose;
};

/// A pose inside an obstacle is moved to the nearest free cell within a metre, and checked; where there is none, and
/// farther outside the map, the robot may be anywhere.
[[nodiscard]] Start usable_start(const OccupancyGrid& map, const InitialPose& given);

/// What is known before the first scan: the middle of what the map shows, give or take all of it; weight 0.
[[nodiscard]] ParticleCluster anywhere_in(const OccupancyGrid& map);

/// The map itself. Throws std::runtime_error where there is none or no cell of it is free.
[[nodiscard]] std::shared_ptr<const OccupancyGrid> with_free_space(std::shared_ptr<const OccupancyGrid> map);

/// Holds a pose against the first scans.
class PoseCheck {
 public:
  static constexpr int kScans = 5;  ///< that are looked at
  enum class Answer : std::uint8_t { kNotYet, kFits, kDoesNotFit };

  void start() { scans_left_ = kScans; }
  void end() { scans_left_ = 0; }
  [[nodiscard]] bool under_way() const { return scans_left_ > 0; }

  /// `fit` of one more scan (explained_share); `enough` of it on the mean is needed.
  Answer observe(double fit, double enough);

 private:
  int scans_left_ = 0;
  double sum_ = 0.0;
};

}  // namespace deltamap::localization::particles
