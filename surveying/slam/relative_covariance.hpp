// SPDX-License-Identifier: Apache-2.0
// How well the pose of each keyframe is known as seen from one of them: the covariances of the links along the best way
// through the graph, one after the other (Bosse et al., "Simultaneous localization and map building in large-scale
// cyclic environments using the Atlas framework", 2004, §IV). Never less than what all ways together tell.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

/// Of each of `wanted`, keyframes, (x, y, θ) in the frame of `seen_from`; none where no way leads there.
[[nodiscard]] std::vector<std::optional<PoseCovariance>> relative_covariances(const Survey& survey,
                                                                              std::uint32_t seen_from,
                                                                              std::span<const std::uint32_t> wanted);

/// Of a from b times b from c, where both are measured independently.
[[nodiscard]] PoseCovariance composed_covariance(const Pose2& a_from_b, const PoseCovariance& of_a_from_b,
                                                 const Pose2& b_from_c, const PoseCovariance& of_b_from_c);
/// Of a pose in a frame that is turned by so much.
[[nodiscard]] PoseCovariance turned_covariance(const PoseCovariance& covariance, double turn_rad);
/// Of b from a, from that of a from b.
[[nodiscard]] PoseCovariance inverted_covariance(const Pose2& a_from_b, const PoseCovariance& of_a_from_b);

}  // namespace deltamap::surveying::slam
