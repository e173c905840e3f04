// SPDX-License-Identifier: Apache-2.0
// The hot path: how badly a scan fits at a pose, as an integer sum of the field's steps. Whole numbers add up the same
// in any order, so that every instruction set gives the same weights; the ends are turned with one sine and cosine a
// pose.
#pragma once

#include <cstdint>
#include <span>

#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/scan_segments.hpp"

namespace deltamap::localization::sensor {

/// Σ over the ends of the field's steps of -ln p(z), with the robot at the pose.
[[nodiscard]] std::int32_t misfit_steps(const LikelihoodField& field, const motion::BeamEnds& ends,
                                        const Pose2& map_from_robot);

/// The same sum, and one in which none of the segments counts more than `most` steps.
struct SegmentedMisfit {
  std::int32_t all = 0;
  std::int32_t bounded = 0;
};
[[nodiscard]] SegmentedMisfit segmented_misfit(const LikelihoodField& field, const motion::BeamEnds& ends,
                                               std::span<const ScanSegment> segments, std::int32_t most,
                                               const Pose2& map_from_robot);

/// Share of the ends that a contour of the map explains rather than chance: p(hit | d) > 1/2. In [0, 1]; 0 without
/// ends.
[[nodiscard]] double explained_share(const LikelihoodField& field, const motion::BeamEnds& ends,
                                     const Pose2& map_from_robot);

/// exp(mean of ln p(z)) for a sum over `beams` ends; in (0, 1]. beams > 0.
[[nodiscard]] double mean_likelihood(std::int64_t steps, std::size_t beams);
/// The same of a scan with the robot at the pose. `ends` must not be empty.
[[nodiscard]] inline double mean_likelihood(const LikelihoodField& field, const motion::BeamEnds& ends,
                                            const Pose2& map_from_robot) {
  return mean_likelihood(misfit_steps(field, ends, map_from_robot), ends.size());
}

}  // namespace deltamap::localization::sensor
