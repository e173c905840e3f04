// SPDX-License-Identifier: Apache-2.0
// Looks for a scan within metres of where the robot is expected: after a long drive without scans that is all that the
// wheels tell. Particles drawn from so wide a prior lie farther apart than the likelihood field guides them; a lattice
// leaves no gap. What is found is to be weighed beside the particles.
#pragma once

#include <vector>

#include "localization/hypotheses/global_search.hpp"
#include "localization/sensor/coarse_field.hpp"
#include "localization/sensor/pose_refinement.hpp"
#include "localization/sensor/proposed_pose.hpp"

namespace deltamap::localization::hypotheses {

/// Poses at which the scan fits, the likeliest first. `headings`: of the lattice.
[[nodiscard]] std::vector<sensor::ProposedPose> poses_within(const sensor::RefinedPose& prior,
                                                             const sensor::CoarseField& coarse,
                                                             const sensor::LikelihoodField& field,
                                                             const GlobalSearch::Ends& ends, int headings);

}  // namespace deltamap::localization::hypotheses
