// SPDX-License-Identifier: Apache-2.0
// Looks for new pose hypotheses while a pose is believed, a few poses at each scan: all over the map on the coarse
// field, and around the believed pose, where a slip ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/random.hpp"
#include "localization/hypotheses/hypothesis_bank.hpp"
#include "localization/hypotheses/lattice_search.hpp"
#include "localization/sensor/coarse_field.hpp"
#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::hypotheses {

class HypothesisProbes {
 public:
  HypothesisProbes(int headings, std::uint64_t seed);

  /// Judges the next `count` poses of the whole map by the ends of a scan.
  void look(const sensor::CoarseField& coarse, const motion::BeamEnds& ends, std::size_t count);
  /// The best of them since it was asked last, where the scan may fit so well (mean ln p(z)) about it.
  [[nodiscard]] std::optional<Pose2> best_anywhere(double fit);

  struct Around {
    Pose2 map_from_believed;
    double distance_m;
    double turn_rad;
  };
  /// The best of `count` poses about the believed one that the bank does not know.
  [[nodiscard]] std::optional<Pose2> best_nearby(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                                 const HypothesisBank& bank, const Around& around, int count);

 private:
  LatticeSearch lattice_;
  Random random_;
};

}  // namespace deltamap::localization::hypotheses
