// SPDX-License-Identifier: Apache-2.0
// The merge of two grids with a prior. Why search near it alone: a hall that repeats itself fits elsewhere as well, and
// the prior excludes that. Of places within the prior that fit alike, floor and walls together (Eq. 11) decide.
#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "core/geometry/points_in_map.hpp"
#include "mapping/merge/thinned.hpp"
#include "surveying/grid_registration/best_nearby.hpp"
#include "surveying/grid_registration/border_registration.hpp"
#include "surveying/grid_registration/edge_registration.hpp"
#include "surveying/grid_registration/prior_merge.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

constexpr std::size_t kPlacingContour = 2000;  // cells of the local contour nearest its middle that place it: no more
                                               // of the map is prepared than they can reach
constexpr std::size_t kContourPoints = 250;    // of these, to be brought onto the map's
constexpr std::size_t kFewEdgeCells = 2500;    // to come near, before more of them count
constexpr double kRoughlySettled_cells = 0.02;
constexpr double kNearlyBestCost = 15.0;        // above the best answer's: Eq. 11 is asked
constexpr double kLeastLead = 0.01;             // in Eq. 11 along the edges, over the second best
constexpr double kNearlySettled_cells = 0.03;   // well inside the reach of the last search
constexpr std::size_t kMostEdgeContour = 1750;  // whose cells and neighbours count at the end

/// Of many, those that lie on the map at the guess and nearest to the middle.
std::vector<Cell> placing_cells(const OccupancyGrid& map, const OccupancyGrid& local, const std::vector<Cell>& contour,
                                const Point2& middle, const Pose2& map_from_local_guess) {
  if (contour.size() <= kPlacingContour) return contour;
  const PointsInMap in_map{map_from_local_guess};
  std::vector<std::pair<double, Cell>> by_distance;
  by_distance.reserve(contour.size());
  for (const Cell& cell : contour) {
    if (!map.geometry().contains(map.geometry().cell_at(in_map(local.geometry().centre_of(cell))))) continue;
    by_distance.emplace_back((Point2{cell.column + 0.5, cell.row + 0.5} - middle).squaredNorm(), cell);
  }
  const std::size_t count = std::min(kPlacingContour, by_distance.size());
  std::nth_element(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(count), by_distance.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Cell> nearest;
  nearest.reserve(count);
  for (std::size_t i = 0; i < count; ++i) nearest.push_back(by_distance[i].second);
  return nearest;
}

struct Choice {
  mapping::merge::MergeRefusal refusal = mapping::merge::MergeRefusal::kTooFewPoints;
  const PriorAnswer* answer = nullptr;
};

/// The best answer; or of those nearly as good the one with the greatest Eq. 11, which knows floor from wall.
template <typename AcceptanceOf>
Choice chosen(const std::vector<PriorAnswer>& answers, const PriorMergeParams& params, AcceptanceOf&& acceptance_of) {
  if (answers.empty()) return {};
  std::vector<const PriorAnswer*> candidates;
  for (const PriorAnswer& answer : answers) {
    const bool is_nearly_best = answer.cost < answers.front().cost + kNearlyBestCost;
    if (is_nearly_best && refusal_of(answer, params) == mapping::merge::MergeRefusal::kNone)
      candidates.push_back(&answer);
  }
  if (candidates.empty()) return {refusal_of(answers.front(), params), &answers.front()};
  if (candidates.size() == 1) return {mapping::merge::MergeRefusal::kNone, candidates.front()};
  double best = -1.0;
  double second = -1.0;
  const PriorAnswer* answer = nullptr;
  for (const PriorAnswer* const candidate : candidates) {
    const double acceptance = acceptance_of(*candidate);
    second = std::max(second, std::min(best, acceptance));
    if (acceptance > best) best = acceptance, answer = candidate;
  }
  return {best < second + kLeastLead ? mapping::merge::MergeRefusal::kAmbiguous : mapping::merge::MergeRefusal::kNone,
          answer};
}

}  // namespace

PriorMerge prior_merge(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local_guess,
                       const PoseCovariance& covariance, const PriorMergeParams& params) {
  assert(map.resolution_m() == local.resolution_m() && "both maps must have the same resolution");
  const double resolution_m = map.resolution_m();
  const std::vector<Cell> contour = contour_cells(local);
  const Point2 middle = mapping::merge::middle_of(contour, local);
  const Point2 middle_in_local = local.geometry().origin + resolution_m * middle;
  std::vector<Point2> points;
  for (const Cell& cell :
       mapping::merge::thinned_to(placing_cells(map, local, contour, middle, map_from_local_guess), kContourPoints))
    points.emplace_back(map_from_local_guess * local.geometry().centre_of(cell));
  const std::vector<PriorAnswer> answers =
      prior_answers(map, points, {map_from_local_guess * middle_in_local, covariance}, params);
  const std::vector<EdgeCell> edges = edge_cells(local, mapping::merge::thinned_to(contour, kMostEdgeContour), middle);
  const std::vector<EdgeCell> few_edges = mapping::merge::thinned_to(edges, kFewEdgeCells);
  const auto near = [&](const PriorAnswer& answer) {
    const Pose2 rough = answer.map_from_guess * map_from_local_guess;
    return edge_registration(map, few_edges, mapping::merge::cell_motion(rough, map.geometry(), middle_in_local),
                             {.settled_cells = kRoughlySettled_cells});
  };
  const Choice choice = chosen(answers, params, [&](const PriorAnswer& answer) {
    return edge_acceptance(map, few_edges, near(answer)).value();
  });
  PriorMerge merge;
  merge.refusal = choice.refusal;
  if (choice.answer == nullptr) return merge;
  merge.covariance = choice.answer->covariance;
  merge.agreement = choice.answer->agreement;
  if (!merge.accepted()) return merge;

  mapping::merge::CellMotion motion = near(*choice.answer);
  motion = border_registration(map, edges, motion, {.settled_cells = kNearlySettled_cells});
  motion = best_nearby(map, edges, motion);
  merge.map_from_guess =
      mapping::merge::map_from_local(motion, map.geometry(), middle_in_local) * inverse(map_from_local_guess);
  return merge;
}

}  // namespace deltamap::surveying::grid_registration
