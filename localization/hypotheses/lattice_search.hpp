// SPDX-License-Identifier: Apache-2.0
// Judges a lattice of poses in the free space of the map, some at each scan: one pose in the middle of each free block
// and for each heading, by the coarse field. Remembers where it stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "localization/sensor/coarse_field.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::hypotheses {

struct Candidate {
  Pose2 map_from_robot;
  std::int32_t misfit = 0;   ///< on the coarse field
  std::uint32_t number = 0;  ///< in the lattice; decides between equals
  std::uint32_t beams = 0;   ///< that the misfit is of
};

/// Mean ln p(z) that a newcomer may fit worse by than the believed pose.
inline constexpr double kFitsNearlyAsWell = 0.15;

/// May the scan fit so well (mean ln p(z)) about there? Few poses, refined to their best fit, fit much better than
/// their block.
[[nodiscard]] bool may_reach(const Candidate& candidate, double fit);

class LatticeSearch {
 public:
  static constexpr std::size_t kFew = 8;  ///< enough where one newcomer is taken at a time
  /// To be kept for each candidate that is refined to its best fit: neighbours in the lattice fit alike.
  static constexpr std::size_t kKeptForEach = 6;

  /// `most` are kept of each look; > 0.
  explicit LatticeSearch(int headings, std::size_t most = kFew);

  /// Forgets what was found, not where it stopped.
  void clear();

  /// Judges the next `count` poses by the scan, but none beyond the lattice's last: the next one is the first again.
  void look(const sensor::CoarseField& field, const motion::BeamEnds& ends, std::size_t count);

  /// Judges the poses that the prior does not exclude, wherever it stopped: within four deviations of it.
  void look_within(const sensor::CoarseField& field, const motion::BeamEnds& ends, const sensor::RefinedPose& prior);

  /// The best of all looks since clear(), the best first; each half a metre or 15° away from those before.
  [[nodiscard]] std::vector<Candidate> best_apart(std::size_t count);

  [[nodiscard]] std::size_t poses(const sensor::CoarseField& field) const {
    return headings_ * field.free_blocks().size();
  }

 private:
  [[nodiscard]] double heading_rad(std::size_t nth) const;
  /// The free blocks [from, until) with the nth heading.
  void judge(const sensor::CoarseField& field, const sensor::TurnedBeams& beams, std::size_t nth_heading,
             std::size_t from, std::size_t until);
  void keep(const Candidate& candidate);

  std::size_t headings_;
  std::size_t stride_;  // between headings looked at one after the other
  std::size_t most_;
  std::size_t next_heading_ = 0;
  std::size_t next_block_ = 0;
  std::vector<Candidate> best_;  // a heap, the worst in front
};

}  // namespace deltamap::localization::hypotheses
