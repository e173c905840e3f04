// SPDX-License-Identifier: Apache-2.0
// Merges one map with another that was turned and shifted at random, again and again, and counts how it went.
#pragma once

#include <chrono>
#include <cstdio>

#include "core/geometry/angle.hpp"
#include "mapping/merge/map_merge.hpp"
#include "tests/support/merge/merge_trial.hpp"

namespace deltamap::test {

struct MergeTally {
  int trials = 0;
  int right = 0;  ///< within 3 cells at the local map's middle and 1.5°
  int refused = 0;
  int wrong_accepted = 0;
  double acceptance = 0.0;  ///< mean, Eq. 11
  double least_acceptance = 1.0;
  double error_cells = 0.0;  ///< mean over the right ones
  double seconds = 0.0;      ///< mean
};

/// `merge(local)` answers a MapMerge onto a map of `resolution_m`; `world` is what local maps are cut from.
template <typename Merge>
MergeTally tally_of(Merge&& merge, const OccupancyGrid& world, double resolution_m, int trials, std::uint64_t seed) {
  Random random{seed};
  MergeTally tally;
  for (; tally.trials < trials; ++tally.trials) {
    const Pose2 local_from_map{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                               radians(random.uniform(-180.0, 180.0))};
    const OccupancyGrid local = moved_grid(world, local_from_map, resolution_m);
    const auto start = std::chrono::steady_clock::now();
    const mapping::merge::MapMerge merged = merge(local);
    tally.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / trials;
    const Point2 middle_in_map = inverse(local_from_map) * mapping::merge::LocalCells{local}.middle_in_local();
    const Pose2 error = merged.map_from_local * local_from_map;
    const double off_cells = (error * middle_in_map - middle_in_map).norm() / resolution_m;
    const bool is_right = off_cells < 3.0 && std::abs(error.theta) < radians(1.5);
    tally.right += is_right ? 1 : 0;
    tally.refused += merged.accepted() ? 0 : 1;
    tally.wrong_accepted += merged.accepted() && !is_right ? 1 : 0;
    tally.acceptance += merged.score.acceptance() / trials;
    tally.least_acceptance = std::min(tally.least_acceptance, merged.score.acceptance());
    tally.error_cells += is_right ? off_cells : 0.0;
  }
  if (tally.right > 0) tally.error_cells /= tally.right;
  return tally;
}

inline void print(const char* name, const MergeTally& t) {
  std::printf(
      "%-24s acceptance %.4f (least %.4f)  right %d/%d  refused %d  wrong accepted %d  off %.2f cells  %.1f ms\n", name,
      t.acceptance, t.least_acceptance, t.right, t.trials, t.refused, t.wrong_accepted, t.error_cells, 1e3 * t.seconds);
}

}  // namespace deltamap::test
