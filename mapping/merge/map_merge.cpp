// SPDX-License-Identifier: Apache-2.0
// Why spectra: rotation and both shifts are found one after the other by correlations of one dimension, not by a
// search of all three at once. That asks for walls that are straight and mostly at right angles.
#include "mapping/merge/map_merge.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "mapping/merge/axis_spectrum.hpp"
#include "mapping/merge/hough_spectrum.hpp"

namespace deltamap::mapping::merge {
namespace {

// Hopeless candidates are sorted out by few of the local map's cells, then by more.
constexpr std::size_t kFewCells = 400;
constexpr std::size_t kHopefulByFew = 200;
constexpr std::size_t kMoreCells = 3000;
constexpr int kMaximumWidth_cells = 3;        // a wall a few cells thick makes one maximum
constexpr std::size_t kMostRanks = 120;       // ranks of a column's and a row's maximum, multiplied: 1 is the best
constexpr std::size_t kFinalCandidates = 16;  // scored with every cell

/// Every rotation with the pairs of shifts of which one at least stands out.
std::vector<CellMotion> spectral_candidates(const OccupancyGrid& map, const LocalCells& local,
                                            const MapMergeParams& params) {
  const std::vector<double> map_spectrum = hough_spectrum(about_centre(contour_cells(map), map));
  const std::vector<double> local_spectrum = hough_spectrum(local.contour());
  const int pixels_per_cell = params.pixels_per_cell;
  const int apart = kMaximumWidth_cells * pixels_per_cell;
  const AxisSpectra map_axes = axis_spectra(map, pixels_per_cell);
  std::vector<CellMotion> candidates;
  for (const double turn_rad : best_turns(map_spectrum, local_spectrum, params.rotations, false)) {
    const AxisSpectra turned = axis_spectra(local.contour(), turn_rad, pixels_per_cell);
    const std::vector<int> columns = best_shifts(map_axes.x, turned.x, params.shifts, apart);
    const std::vector<int> rows = best_shifts(map_axes.y, turned.y, params.shifts, apart);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      for (std::size_t k = 0; k < rows.size() && (i + 1) * (k + 1) <= kMostRanks; ++k) {
        candidates.push_back({turn_rad, static_cast<double>(columns[i]) / pixels_per_cell,
                              static_cast<double>(rows[k]) / pixels_per_cell});
      }
    }
  }
  return candidates;
}

/// The n best candidates by a sample of the local map's cells.
std::vector<CellMotion> best_by_sample(const std::vector<CellMotion>& candidates, std::size_t n, const OverlayMap& map,
                                       const LocalCells& sample) {
  struct Rated {
    CellMotion motion;
    double rating;
  };
  std::vector<Rated> rated;
  rated.reserve(candidates.size());
  for (const CellMotion& motion : candidates) {
    const OverlayScore score = map.score(sample, motion);
    rated.push_back({motion, score.acceptance() * score.surface_found});
  }
  std::stable_sort(rated.begin(), rated.end(), [](const Rated& a, const Rated& b) { return a.rating > b.rating; });
  if (rated.size() > n) rated.resize(n);
  std::vector<CellMotion> left;
  left.reserve(rated.size());
  for (const Rated& candidate : rated) left.push_back(candidate.motion);
  return left;
}

/// The candidates worth a full count.
std::vector<CellMotion> hopeful(const std::vector<CellMotion>& candidates, const OverlayMap& map,
                                const LocalCells& local) {
  const auto by_few = best_by_sample(candidates, kHopefulByFew, map, local.thinned(kFewCells));
  return best_by_sample(by_few, kFinalCandidates, map, local.thinned(kMoreCells));
}

/// The candidate and its neighbours, as the method asks (§3.4.2).
std::vector<CellMotion> neighbours(const CellMotion& motion, MergeMethod method) {
  const int turns = method == MergeMethod::kMa2   ? 2
                    : method == MergeMethod::kMa3 ? 4
                    : method == MergeMethod::kMa4 ? 1
                                                  : 0;
  const int shifts = method == MergeMethod::kMa4 ? 1 : 0;
  std::vector<CellMotion> all;
  for (int turn = -turns; turn <= turns; ++turn) {
    for (int column = -shifts; column <= shifts; ++column) {
      for (int row = -shifts; row <= shifts; ++row) {
        all.push_back({motion.turn_rad + turn * radians(0.25), motion.column + column, motion.row + row});
      }
    }
  }
  return all;
}

bool clearly_differ(const CellMotion& a, const CellMotion& b) {
  constexpr double kApart_cells = 5.0;
  constexpr double kApart_rad = 0.09;  // 5°
  return std::hypot(a.column - b.column, a.row - b.row) > kApart_cells ||
         std::abs(turn_between(a.turn_rad, b.turn_rad)) > kApart_rad;
}

bool fits_nearly_as_well(const OverlayScore& other, const OverlayScore& best, double margin) {
  return other.surface_found > best.surface_found - margin &&
         other.surface_agreement > best.surface_agreement - margin && other.acceptance() > best.acceptance() - margin;
}

}  // namespace

MapMerge chosen(const std::vector<ScoredMotion>& candidates, const OccupancyGrid& map, const LocalCells& local,
                const ChoiceParams& params) {
  // Eq. 11 decides, but only among poses that find the surface: alone it prefers to lay free space on free space.
  double best_surface = 0.0;
  for (const ScoredMotion& candidate : candidates) {
    if (candidate.score.overlap >= params.least_overlap)
      best_surface = std::max(best_surface, candidate.score.surface_found);
  }
  const ScoredMotion* best = nullptr;
  for (const ScoredMotion& candidate : candidates) {
    if (candidate.score.overlap < params.least_overlap) continue;
    if (candidate.score.surface_found < params.surface_margin * best_surface) continue;
    if (best == nullptr || candidate.score.acceptance() > best->score.acceptance()) best = &candidate;
  }
  MapMerge merge;
  if (best == nullptr) {
    merge.refusal = MergeRefusal::kLowAgreement;
    return merge;
  }
  merge.map_from_local = map_from_local(best->motion, map.geometry(), local);
  merge.score = best->score;
  bool is_ambiguous = false;
  for (const ScoredMotion& candidate : candidates) {
    if (!clearly_differ(candidate.motion, best->motion) || candidate.score.overlap < params.least_overlap) continue;
    is_ambiguous = is_ambiguous || fits_nearly_as_well(candidate.score, best->score, params.ambiguity_margin);
  }
  if (best->score.surface_agreement < params.least_agreement || best->score.acceptance() < params.least_acceptance) {
    merge.refusal = MergeRefusal::kLowAgreement;
  } else if (params.refuse_ambiguous && is_ambiguous) {
    merge.refusal = MergeRefusal::kAmbiguous;
  }
  return merge;
}

MapMerge map_merge(const OccupancyGrid& map, const OccupancyGrid& local, const MapMergeParams& params) {
  assert(map.resolution_m() == local.resolution_m() && "both maps must have the same resolution");
  const LocalCells local_cells{local};
  if (local_cells.contour().size() < kLeastContour) {
    MapMerge refused;
    refused.refusal = MergeRefusal::kTooFewPoints;
    return refused;
  }
  const OverlayMap overlay{map};
  std::vector<ScoredMotion> scored;
  for (const CellMotion& candidate : hopeful(spectral_candidates(map, local_cells, params), overlay, local_cells)) {
    for (const CellMotion& motion : neighbours(candidate, params.method)) {
      scored.push_back({motion, overlay.score(local_cells, motion)});
    }
  }
  return chosen(scored, map, local_cells, params.choice);
}

}  // namespace deltamap::mapping::merge
