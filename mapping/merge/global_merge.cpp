// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/global_merge.hpp"

#include <algorithm>

#include "mapping/alignment/registration.hpp"
#include "mapping/merge/hough_spectrum.hpp"
#include "mapping/merge/shift_correlation.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr std::size_t kLeastContour = 20;     // cells; fewer make no line
constexpr std::size_t kMostPoints = 1200;     // of the local contour, to be brought onto the map's
constexpr std::size_t kCoarseCells = 3000;    // of the local map, to sort out hopeless candidates
constexpr std::size_t kFinalCandidates = 12;  // brought to the end

std::vector<Point2> contour_in_metres(const LocalCells& local, double resolution_m) {
  const std::size_t stride = local.contour().size() / kMostPoints + 1;
  std::vector<Point2> points;
  for (std::size_t i = 0; i < local.contour().size(); i += stride) {
    points.push_back(resolution_m * Point2{local.contour()[i].x, local.contour()[i].y});
  }
  return points;
}

std::vector<PointInCells> contour_about_centre(const OccupancyGrid& map) {
  std::vector<PointInCells> points;
  for (const Cell& cell : contour_cells(map)) {
    points.push_back(
        {static_cast<float>(cell.column - 0.5 * map.width()), static_cast<float>(cell.row - 0.5 * map.height())});
  }
  return points;
}

}  // namespace

MapMerge global_merge(const OccupancyGrid& map, const OccupancyGrid& local, const GlobalMergeParams& params) {
  assert(map.resolution_m() == local.resolution_m() && "both maps must have the same resolution");
  const LocalCells cells{local};
  if (cells.contour().size() < kLeastContour) {
    MapMerge refused;
    refused.refusal = MergeRefusal::kTooFewPoints;
    return refused;
  }
  const OverlayMap overlay{map};
  const LocalCells sample = cells.thinned(kCoarseCells);
  const ShiftCorrelation correlation{map, cells, params.most_pixels};
  std::vector<ScoredMotion> coarse;
  const auto turns = best_turns(hough_spectrum(contour_about_centre(map), params.hough_bins),
                                hough_spectrum(cells.contour(), params.hough_bins), params.rotations, true);
  for (const TurnCandidate& turn : turns) {
    for (const CellMotion& motion : correlation.best_shifts(turn.turn_rad, params.shifts)) {
      coarse.push_back({motion, overlay.score(sample, motion)});
    }
  }

  // Closest lines from every coarse place, over the whole reach that a pixel leaves open.
  const double resolution_m = map.resolution_m();
  const double reach_m = resolution_m * (3.0 + correlation.cells_per_pixel());
  const alignment::NearestSurface surface{alignment::contour_of(map, {{0, 0}, {map.width(), map.height()}}),
                                          resolution_m, reach_m};
  const std::vector<Point2> points = contour_in_metres(cells, resolution_m);
  for (ScoredMotion& candidate : coarse) {
    const Point2 middle = map.geometry().origin + resolution_m * Point2{candidate.motion.column, candidate.motion.row};
    const alignment::Registration end =
        alignment::registration(points, surface, {middle.x(), middle.y(), candidate.motion.turn_rad}, {},
                                {.first_reach_m = reach_m,
                                 .last_reach_m = std::min(reach_m, 2.0 * resolution_m),
                                 .point_deviation_m = 0.3 * resolution_m});
    const Pose2& pose = end.reference_from_moving;
    candidate.motion = {pose.theta, (pose.x - map.geometry().origin.x()) / resolution_m,
                        (pose.y - map.geometry().origin.y()) / resolution_m};
    candidate.score = overlay.score(sample, candidate.motion);
  }
  std::stable_sort(coarse.begin(), coarse.end(), [](const ScoredMotion& a, const ScoredMotion& b) {
    return a.score.acceptance() * a.score.surface_found > b.score.acceptance() * b.score.surface_found;
  });
  if (coarse.size() > kFinalCandidates) coarse.resize(kFinalCandidates);
  for (ScoredMotion& candidate : coarse) candidate.score = overlay.score(cells, candidate.motion);
  return chosen(coarse, map, cells, params.choice);
}

}  // namespace deltamap::mapping::merge
