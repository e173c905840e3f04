// SPDX-License-Identifier: Apache-2.0
// Where could the robot be, when nobody says? Draws many poses over the free space, lets one scan judge them, slides
// the best ones to where they fit, and answers with particles around them. Later scans decide between the places.
#pragma once

#include <vector>

#include "core/angle.hpp"
#include "core/random.hpp"
#include "localization/deskew.hpp"
#include "localization/likelihood_field.hpp"
#include "localization/pose_refinement.hpp"

namespace deltamap::localization {

struct GlobalSearchParams {
  double candidates_per_m2 = 300.0;  ///< poses drawn a square metre of free space, 1/m²; > 0
  int most_candidates = 300000;      ///< however large the map; > 0
  int beams = 45;                    ///< beams that judge a candidate; > 0
  int places = 1000;                 ///< candidates that are slid to their best fit; > 0
  double evidence_beams = 3.0;  ///< independent beams that the scan counts as here; > 0: low keeps more places alive
  double jitter_m = 0.1;        ///< spread of the particles around a place, m; >= 0
  double jitter_rad = radians(2.0);  ///< likewise, rad; >= 0
};

/// Indices of the free cells (GridGeometry::index_of), rising.
[[nodiscard]] std::vector<std::uint32_t> free_cells(const OccupancyGrid& map);

/// `count` poses spread evenly over the free cells, with any heading. `cells` must not be empty.
[[nodiscard]] std::vector<Pose2> poses_anywhere(const GridGeometry& geometry, const std::vector<std::uint32_t>& cells,
                                                std::size_t count, Random& random);

/// `count` poses where the scan says the robot may be; `also` is tried beside the draws (what was believed until now).
[[nodiscard]] std::vector<Pose2> poses_that_fit(const LikelihoodField& field, const OccupancyGrid& map,
                                                const BeamEnds& ends, std::size_t count, const Pose2& also,
                                                const GlobalSearchParams& params, Random& random);

}  // namespace deltamap::localization
