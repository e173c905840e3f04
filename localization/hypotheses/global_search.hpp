// SPDX-License-Identifier: Apache-2.0
// Global localization: searches the whole map with one scan. A lattice of poses is judged on the coarse field, so many
// poses at each scan, then the best candidates are refined, so many at each scan: no single scan takes long. Which
// candidate is true is decided by later scans (hypothesis_bank.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/angle.hpp"
#include "localization/hypotheses/lattice_search.hpp"

namespace deltamap::localization::hypotheses {

/// Of one scan.
struct SearchShare {
  int candidates = 0;  ///< poses looked at; > 0
  int refined = 0;     ///< candidates that are refined to their best fit; > 0
};

struct GlobalSearchParams {
  SearchShare alone{5'000'000, 200};       ///< while nothing is believed: a hall of 100 m at once, 20 ms of a fast core
  SearchShare beside{50'000, 40};          ///< beside a believed pose
  int refined = 600;                       ///< candidates that are refined to their best fit; > 0
  double again_after_m = 0.5;              ///< driven until the whole map is looked at again, m; > 0
  double again_after_rad = radians(30.0);  ///< or heading turned until then, rad; > 0
};

/// Refines a pose of the coarse lattice to where the scan fits.
[[nodiscard]] Pose2 settled(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& pose);

class GlobalSearch {
 public:
  GlobalSearch(const GlobalSearchParams& params, int headings);

  /// The next scan begins a new look at the whole map.
  void start();
  [[nodiscard]] bool under_way() const { return stage_ != Stage::kDone; }

  /// Of one scan, robot frame.
  struct Ends {
    const motion::BeamEnds& all;
    const motion::BeamEnds& near;  ///< that a coarse lattice of headings can place; may be all
  };

  /// One scan's share of the work. Answers poses at which this scan fits; valid until the next call. `beside` a
  /// believed pose: slowly.
  [[nodiscard]] std::span<const Pose2> look(const sensor::CoarseField& coarse, const sensor::LikelihoodField& field,
                                            const Ends& ends, const Pose2& continuous_odom_from_robot,
                                            bool beside = false);

 private:
  enum class Stage : std::uint8_t { kBegin, kLooking, kSliding, kDone };
  [[nodiscard]] bool due_again(const Pose2& continuous_odom_from_robot) const;

  GlobalSearchParams params_;
  LatticeSearch lattice_;
  Stage stage_ = Stage::kBegin;
  motion::BeamEnds ends_;             // of the scan that the whole map is held against
  Pose2 continuous_odom_from_robot_;  // where it was taken
  std::size_t left_ = 0;              // poses to look at
  std::vector<Candidate> candidates_;
  std::size_t next_ = 0;  // candidate to refine
  std::vector<Pose2> hypotheses_;
};

}  // namespace deltamap::localization::hypotheses
