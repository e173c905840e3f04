// SPDX-License-Identifier: Apache-2.0
// Cuts the ends of a scan into segments that lie on one object. A container that was moved misleads every beam that
// meets it in the same way, so that its beams are one observation against a pose, not thirty. What a segment can say is
// bounded by the odds that its object stands elsewhere than the map has it: a mixture of "holds" and "was moved", by
// segment.
#pragma once

#include <cstdint>
#include <vector>

#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::sensor {

/// Deviation of what was moved, about where it stood, m.
inline constexpr double kMovedM = 0.5;
/// P(stands where the map has it) of a thing that nothing is known of.
inline constexpr double kUsuallyHolds = 0.9;
/// Longest piece of a surface that moves as one, m: a container does, a whole aisle does not.
inline constexpr double kMovesAsOneM = 2.0;

struct ScanSegment {
  std::uint32_t first = 0;  ///< its first end
  std::uint32_t past = 0;   ///< one past its last
  [[nodiscard]] std::uint32_t size() const { return past - first; }
  friend bool operator==(const ScanSegment&, const ScanSegment&) = default;
};

/// Those of at least so many ends, in order. A segment ends where the next end lies apart, and where it has grown as
/// long as things are that move as one. Reuses the memory of `segments`.
[[nodiscard]] std::vector<ScanSegment> segmented(const motion::BeamEnds& ends, std::size_t fewest,
                                                 std::vector<ScanSegment> segments = {});

/// What a segment says against a pose at most.
struct SegmentBound {
  std::int32_t steps = 0;  ///< of the field's
  std::size_t fewest = 1;  ///< ends that can reach beyond it
};
/// It costs −ln P(moved) nats that a thing was moved, and ln(σ_moved / σ_hit) that it stands anywhere near.
/// `of_a_beam`: what each beam's evidence counts, (0, 1].
[[nodiscard]] SegmentBound segment_bound(const LikelihoodFieldParams& params, double hit_deviation_m, double of_a_beam);

}  // namespace deltamap::localization::sensor
