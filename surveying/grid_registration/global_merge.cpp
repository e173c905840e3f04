// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/global_merge.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/merge/hough_spectrum.hpp"
#include "mapping/merge/thinned.hpp"
#include "mapping/registration/registration.hpp"
#include "surveying/grid_registration/best_nearby.hpp"
#include "surveying/grid_registration/border_registration.hpp"
#include "surveying/grid_registration/edge_registration.hpp"
#include "surveying/grid_registration/shift_correlation.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

constexpr int kRotations = 6;     // maxima of Eq. 6; each is also tried half a turn on
constexpr int kShifts = 12;       // best shifts for each rotation: racks repeat
constexpr double kPixelM = 0.4;   // of the correlated pictures, at least
constexpr int kMostPixels = 320;  // along a side of the correlated pictures; larger maps are shrunk further
constexpr std::size_t kSpectrumPoints = 2000;   // of a contour, for its Hough spectrum
constexpr std::size_t kSortedPoints = 300;      // of the local contour, to sort out hopeless candidates
constexpr std::size_t kRegisteredPoints = 600;  // of the local contour, to be brought onto the map's
constexpr std::size_t kFewCells = 1000;         // of the local map, to sort out hopeless candidates
constexpr std::size_t kSampleCells = 3000;      // of the local map, to choose among registered ones
constexpr std::size_t kRegistered = 24;         // candidates brought onto the map's lines
constexpr std::size_t kFinal = 4;               // brought to the end, scored with every cell
constexpr std::size_t kRoughEdgeCells = 3000;

/// With the pose brought to the end, less may be wrong than at the published merges' half degrees. Maps of one place,
/// bare and furnished, agreed in 0.86 of the contour and more; racks one bay off in 0.76 and less.
mapping::merge::ChoiceParams stricter_choice() {
  mapping::merge::ChoiceParams choice;
  choice.least_overlap = 0.2;
  choice.least_agreement = 0.8;
  choice.least_acceptance = 0.93;
  return choice;
}

void sort_best_first(std::vector<mapping::merge::ScoredMotion>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const mapping::merge::ScoredMotion& a, const mapping::merge::ScoredMotion& b) {
                     return a.score.acceptance() * a.score.surface_found > b.score.acceptance() * b.score.surface_found;
                   });
}

/// The n best, none beside a better one: by Eq. 11 among those that find the surface, as the choice will be.
std::vector<mapping::merge::ScoredMotion> best_apart(std::vector<mapping::merge::ScoredMotion> candidates,
                                                     std::size_t n, double surface_margin) {
  constexpr double kApart_cells = 2.0;
  constexpr double kApart_rad = 0.02;
  double best_surface = 0.0;
  for (const mapping::merge::ScoredMotion& candidate : candidates)
    best_surface = std::max(best_surface, candidate.score.surface_found);
  std::erase_if(candidates, [&](const mapping::merge::ScoredMotion& candidate) {
    return candidate.score.surface_found < surface_margin * best_surface;
  });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const mapping::merge::ScoredMotion& a, const mapping::merge::ScoredMotion& b) {
                     return a.score.acceptance() > b.score.acceptance();
                   });
  std::vector<mapping::merge::ScoredMotion> best;
  for (const mapping::merge::ScoredMotion& candidate : candidates) {
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const mapping::merge::ScoredMotion& better) {
      return std::hypot(better.motion.column - candidate.motion.column, better.motion.row - candidate.motion.row) <
                 kApart_cells &&
             std::abs(turn_between(better.motion.turn_rad, candidate.motion.turn_rad)) < kApart_rad;
    });
    if (is_new) best.push_back(candidate);
    if (best.size() == n) break;
  }
  return best;
}

/// Closest lines from where the search left it.
class LineRegistration {
 public:
  LineRegistration(const OccupancyGrid& map, const mapping::merge::LocalCells& local, double pixel_m)
      : geometry_{map.geometry()},
        reach_m_{pixel_m + 3.0 * map.resolution_m()},
        surface_{mapping::registration::contour_of(map, {{0, 0}, {map.width(), map.height()}}), map.resolution_m(),
                 reach_m_} {
    for (const mapping::merge::PointInCells& point : mapping::merge::thinned_to(local.contour(), kRegisteredPoints)) {
      points_.push_back(geometry_.resolution_m * Point2{point.x, point.y});
    }
    const auto resolution_m = static_cast<float>(geometry_.resolution_m);
    for (const mapping::merge::PointInCells& point : mapping::merge::thinned_to(local.contour(), kSortedPoints))
      sample_m_.push_back({resolution_m * point.x, resolution_m * point.y});
  }

  /// How much of the contour lies near a surface, less the farther it is: of candidates that are some cells off.
  [[nodiscard]] double nearness(const mapping::merge::CellMotion& motion) const {
    const double resolution_m = geometry_.resolution_m;
    const auto c = static_cast<float>(std::cos(motion.turn_rad));
    const auto s = static_cast<float>(std::sin(motion.turn_rad));
    const auto x_m = static_cast<float>(geometry_.origin.x() + resolution_m * motion.column);
    const auto y_m = static_cast<float>(geometry_.origin.y() + resolution_m * motion.row);
    float sum_m2 = 0.0F;
    for (const mapping::merge::PointInCells& point : sample_m_)
      sum_m2 += surface_.rough_distance2(x_m + c * point.x - s * point.y, y_m + s * point.x + c * point.y);
    return 1.0 - static_cast<double>(sum_m2) / (reach_m_ * reach_m_ * static_cast<double>(sample_m_.size()));
  }

  [[nodiscard]] mapping::merge::CellMotion registered(const mapping::merge::CellMotion& motion) const {
    const double resolution_m = geometry_.resolution_m;
    const Point2 middle = geometry_.origin + resolution_m * Point2{motion.column, motion.row};
    const mapping::registration::Registration end =
        mapping::registration::registration(points_, surface_, {middle.x(), middle.y(), motion.turn_rad}, {},
                                            {.first_reach_m = reach_m_,
                                             .last_reach_m = std::min(reach_m_, 2.0 * resolution_m),
                                             .point_deviation_m = 0.3 * resolution_m});
    const Pose2& pose = end.reference_from_moving;
    return {pose.theta, (pose.x - geometry_.origin.x()) / resolution_m, (pose.y - geometry_.origin.y()) / resolution_m};
  }

 private:
  GridGeometry geometry_;
  double reach_m_;
  mapping::registration::NearestSurface surface_;
  std::vector<Point2> points_;
  std::vector<mapping::merge::PointInCells> sample_m_;
};

/// The rotations of Eq. 6; every other one is the one before it and half a turn.
std::vector<double> rotations_of(const OccupancyGrid& map, const std::vector<Cell>& contour,
                                 const mapping::merge::LocalCells& cells) {
  return mapping::merge::best_turns(
      mapping::merge::hough_spectrum(
          mapping::merge::about_centre(mapping::merge::thinned_to(contour, kSpectrumPoints), map)),
      mapping::merge::hough_spectrum(mapping::merge::thinned_to(cells.contour(), kSpectrumPoints)), kRotations, true);
}

/// The best shifts of each rotation that are worth registering, best first.
std::vector<mapping::merge::ScoredMotion> candidates_of(const std::vector<double>& turns_rad,
                                                        const ShiftCorrelation& correlation,
                                                        const mapping::merge::OverlayMap& overlay,
                                                        const mapping::merge::LocalCells& few,
                                                        const LineRegistration& lines) {
  std::vector<mapping::merge::ScoredMotion> candidates;
  for (std::size_t i = 0; i < turns_rad.size(); i += 2) {  // the half turns come with them
    for (const mapping::merge::CellMotion& motion : correlation.best_shifts(turns_rad[i], kShifts)) {
      candidates.push_back({motion, overlay.score(few, motion)});
      // Surfaces within a cell tell nothing of candidates that are half a pixel off.
      candidates.back().score.surface_found = lines.nearness(motion);
    }
  }
  sort_best_first(candidates);
  if (candidates.size() > kRegistered) candidates.resize(kRegistered);
  return candidates;
}

/// The local map's cells at its contour, which bring a candidate to the end.
struct Edges {
  std::vector<EdgeCell> all;
  std::vector<EdgeCell> few;
};

Edges edges_of(const OccupancyGrid& local, const std::vector<Cell>& contour) {
  Edges edges{edge_cells(local, contour, mapping::merge::middle_of(contour, local)), {}};
  edges.few = mapping::merge::thinned_to(edges.all, kRoughEdgeCells);
  return edges;
}

/// From the lines' answer to the edges', first with few of them.
mapping::merge::CellMotion brought_to_end(const OccupancyGrid& map, const Edges& edges,
                                          const mapping::merge::CellMotion& motion) {
  return edge_registration(map, edges.all, edge_registration(map, edges.few, motion, {}), {});
}

/// What was chosen, moved to where most cells agree.
void refine(mapping::merge::MapMerge& merge, const OccupancyGrid& map, const mapping::merge::OverlayMap& overlay,
            const mapping::merge::LocalCells& cells, const Edges& edges) {
  mapping::merge::CellMotion best = mapping::merge::cell_motion(merge.map_from_local, map.geometry(), cells);
  best = border_registration(map, edges.all, best, {});
  best = best_nearby(map, edges.all, best);
  merge.map_from_local = mapping::merge::map_from_local(best, map.geometry(), cells);
  merge.score = overlay.score(cells, best);
}

}  // namespace

mapping::merge::MapMerge global_merge(const OccupancyGrid& map, const OccupancyGrid& local) {
  assert(map.resolution_m() == local.resolution_m() && "both maps must have the same resolution");
  const std::vector<Cell> local_contour = contour_cells(local);
  const mapping::merge::LocalCells cells{local, local_contour};
  if (cells.contour().size() < mapping::merge::kLeastContour) {
    mapping::merge::MapMerge refused;
    refused.refusal = mapping::merge::MergeRefusal::kTooFewPoints;
    return refused;
  }
  const std::vector<Cell> contour = contour_cells(map);
  const mapping::merge::OverlayMap overlay{map, contour};
  const int cells_per_pixel = std::max(1, static_cast<int>(std::lround(kPixelM / map.resolution_m())));
  const ShiftCorrelation correlation{map, contour, cells, cells_per_pixel, kMostPixels};
  const LineRegistration lines{map, cells, map.resolution_m() * correlation.cells_per_pixel()};
  std::vector<mapping::merge::ScoredMotion> candidates =
      candidates_of(rotations_of(map, contour, cells), correlation, overlay, cells.thinned(kFewCells), lines);

  const mapping::merge::LocalCells sample = cells.thinned(kSampleCells);
  for (mapping::merge::ScoredMotion& candidate : candidates) {
    candidate.motion = lines.registered(candidate.motion);
    candidate.score = overlay.score(sample, candidate.motion);
  }
  const mapping::merge::ChoiceParams choice = stricter_choice();
  candidates = best_apart(std::move(candidates), kFinal, choice.surface_margin);
  const Edges edges = edges_of(local, local_contour);
  for (mapping::merge::ScoredMotion& candidate : candidates) {
    candidate.motion = brought_to_end(map, edges, candidate.motion);
    candidate.score = overlay.score(cells, candidate.motion);
  }
  mapping::merge::MapMerge merge = mapping::merge::chosen(candidates, map, cells, choice);
  if (merge.score.agreeing > 0.0) refine(merge, map, overlay, cells, edges);
  return merge;
}

}  // namespace deltamap::surveying::grid_registration
