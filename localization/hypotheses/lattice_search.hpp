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
  static constexpr std::size_t kInQuad = 4;  ///< poses
  static constexpr std::size_t kFew = 8;     ///< enough where one newcomer is taken at a time
  /// To be kept for each candidate that is refined to its best fit: neighbours in the lattice fit alike.
  static constexpr std::size_t kKeptForEach = 6;

  /// `most` are kept of each look; > 0.
  explicit LatticeSearch(int headings, std::size_t most = kFew);

  /// Forgets what was found, not where it stopped.
  void clear();

  /// Judges about the next `count` poses by the scan, but none beyond the lattice's last: the next one is the first
  /// again. Four poses of one heading side by side at once: those that cannot be among the best are left out.
  void look(const sensor::CoarseField& field, const motion::BeamEnds& ends, std::size_t count);

  /// Judges the poses that the prior does not exclude, wherever it stopped: within four deviations of it.
  void look_within(const sensor::CoarseField& field, const motion::BeamEnds& ends, const sensor::RefinedPose& prior);

  /// The best of all looks since clear(), the best first; each half a metre or 15° away from those before.
  [[nodiscard]] std::vector<Candidate> best_apart(std::size_t count);

  /// To be counted by look(): four in each quad with a free block.
  [[nodiscard]] std::size_t poses(const sensor::CoarseField& field) const {
    return headings_ * kInQuad * field.free_quads().size();
  }

 private:
  [[nodiscard]] double heading_rad(std::size_t nth) const;
  /// The free blocks [from, until) with the nth heading.
  void judge(const sensor::CoarseField& field, const sensor::TurnedBeams& beams, std::size_t nth_heading,
             std::size_t from, std::size_t until);
  /// The free quads [from, until) with the nth heading.
  void judge_quads(const sensor::CoarseField& field, const sensor::TurnedBeams& beams, std::size_t nth_heading,
                   std::size_t from, std::size_t until);
  /// A row of blocks in so many quads, beginning with the block at this column; those whose bits are set.
  void judge_row(const sensor::CoarseField& field, const sensor::TurnedBeams& beams, std::size_t nth_heading,
                 const Cell& first, std::uint32_t quads);
  /// Nothing that is worse in any block is among the best.
  [[nodiscard]] bool may_keep(std::int32_t least_misfit) const {
    return best_.size() < most_ || least_misfit <= best_.front().misfit;
  }
  void keep(const Candidate& candidate);
  [[nodiscard]] Candidate candidate_at(const sensor::CoarseField& field, const sensor::TurnedBeams& beams,
                                       std::size_t nth_heading, std::uint32_t block, std::int32_t misfit) const;

  std::size_t headings_;
  std::size_t stride_;  // between headings looked at one after the other
  std::size_t most_;
  std::size_t next_heading_ = 0;
  std::size_t next_quad_ = 0;
  std::vector<Candidate> best_;  // a heap, the worst in front
};

}  // namespace deltamap::localization::hypotheses
