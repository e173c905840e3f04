// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_probes.hpp"

#include <limits>

#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::hypotheses {
HypothesisProbes::HypothesisProbes(int headings, std::uint64_t seed) : lattice_{headings}, random_{seed} {}

void HypothesisProbes::look(const sensor::CoarseField& coarse, const motion::BeamEnds& ends, std::size_t count) {
  lattice_.look(coarse, ends, count);
}

std::optional<Pose2> HypothesisProbes::best_anywhere(double fit) {
  for (const Candidate& candidate : lattice_.best_apart(1)) {
    if (may_reach(candidate, fit)) return candidate.map_from_robot;
  }
  return std::nullopt;
}

std::optional<Pose2> HypothesisProbes::best_nearby(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                                   const HypothesisBank& bank, const Around& around, int count) {
  const Pose2& believed = around.map_from_believed;
  std::optional<Pose2> best;
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  for (int i = 0; i < count; ++i) {
    const double x_m = random_.uniform(-around.distance_m, around.distance_m);
    const double y_m = random_.uniform(-around.distance_m, around.distance_m);
    const double turn_rad = random_.uniform(-around.turn_rad, around.turn_rad);
    const Pose2 tried{believed.x + x_m, believed.y + y_m, wrapped_angle(believed.theta + turn_rad)};
    if (bank.knows(tried)) continue;
    const std::int32_t misfit = sensor::misfit_steps(field, ends, tried);
    if (misfit >= least) continue;
    least = misfit;
    best = tried;
  }
  return best;
}

}  // namespace deltamap::localization::hypotheses
