// SPDX-License-Identifier: Apache-2.0
// A few particles that stand for all of them: to be looked at, not to be computed with.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "localization/particles/particle_set.hpp"

namespace deltamap::localization::particles {

/// At most `most` poses, each standing for the same share of the weight (systematic sampling without a random start);
/// all of them where there are no more than that. Fewer where one particle holds several shares: it is answered once.
[[nodiscard]] std::vector<Pose2> sampled_poses(const ParticleSet& particles, std::size_t most);

}  // namespace deltamap::localization::particles
