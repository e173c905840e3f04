// SPDX-License-Identifier: Apache-2.0
#include "localization/global_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "localization/resampling.hpp"
#include "localization/weighing.hpp"

namespace deltamap::localization {
namespace {

struct Candidate {
  Pose2 map_from_robot;
  std::int32_t misfit = 0;
  std::uint32_t number = 0;  ///< decides between equals
};

BeamEnds thinned(const BeamEnds& ends, std::size_t count) {
  if (ends.size() <= count) return ends;
  BeamEnds few;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * ends.size() / count;
    few.x_m.push_back(ends.x_m[from]);
    few.y_m.push_back(ends.y_m[from]);
  }
  return few;
}

/// The best first, each at least a step away from the better ones: otherwise one corner takes all the places.
std::vector<Candidate> best_places(std::vector<Candidate> candidates, std::size_t count) {
  constexpr double kApartM = 0.25;
  constexpr double kApartRad = 0.15;
  const std::size_t looked_at = std::min(candidates.size(), 5 * count);
  const auto better = [](const Candidate& a, const Candidate& b) {
    return a.misfit != b.misfit ? a.misfit < b.misfit : a.number < b.number;
  };
  std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(looked_at), candidates.end(),
                    better);
  std::vector<Candidate> places;
  for (std::size_t i = 0; i < looked_at && places.size() < count; ++i) {
    const Pose2& pose = candidates[i].map_from_robot;
    const bool apart = std::none_of(places.begin(), places.end(), [&](const Candidate& place) {
      return distance_between(pose, place.map_from_robot) < kApartM &&
             std::abs(turn_between(pose.theta, place.map_from_robot.theta)) < kApartRad;
    });
    if (apart) places.push_back(candidates[i]);
  }
  return places;
}

}  // namespace

std::vector<std::uint32_t> free_cells(const OccupancyGrid& map) {
  std::vector<std::uint32_t> cells;
  for (std::size_t i = 0; i < map.cells().size(); ++i) {
    if (map.cells()[i] == CellState::kFree) cells.push_back(static_cast<std::uint32_t>(i));
  }
  return cells;
}

std::vector<Pose2> poses_anywhere(const GridGeometry& geometry, const std::vector<std::uint32_t>& cells,
                                  std::size_t count, Random& random) {
  std::vector<Pose2> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // A comb over the cells spreads better than chance alone.
    const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
    const std::size_t cell =
        std::min(cells.size() - 1, static_cast<std::size_t>(at * static_cast<double>(cells.size())));
    const Point2 centre = geometry.centre_of(geometry.cell_of(cells[cell]));
    const double half_m = 0.5 * geometry.resolution_m;
    const double x_m = centre.x() + random.uniform(-half_m, half_m);
    const double y_m = centre.y() + random.uniform(-half_m, half_m);
    poses.push_back({x_m, y_m, wrapped_angle(random.uniform(-std::numbers::pi, std::numbers::pi))});
  }
  return poses;
}

std::vector<Pose2> poses_that_fit(const LikelihoodField& field, const OccupancyGrid& map, const BeamEnds& ends,
                                  std::size_t count, const Pose2& also, const GlobalSearchParams& params,
                                  Random& random) {
  const std::vector<std::uint32_t> cells = free_cells(map);
  const double free_m2 = static_cast<double>(cells.size()) * map.resolution_m() * map.resolution_m();
  const auto drawn = static_cast<std::size_t>(std::clamp(params.candidates_per_m2 * free_m2, 1000.0,
                                                         static_cast<double>(std::max(1000, params.most_candidates))));
  const BeamEnds judges = thinned(ends, static_cast<std::size_t>(params.beams));
  std::vector<Candidate> candidates;
  candidates.reserve(drawn);
  for (const Pose2& pose : poses_anywhere(map.geometry(), cells, drawn, random)) {
    candidates.push_back({pose, misfit_steps(field, judges, pose), static_cast<std::uint32_t>(candidates.size())});
  }
  std::vector<Candidate> places = best_places(std::move(candidates), static_cast<std::size_t>(params.places));
  places.push_back({also});

  const RefinementParams sliding{.steps = 10, .prior_share = 1.0, .longest_shift_m = 0.6, .largest_turn_rad = 0.35};
  const PoseCovariance loose = Eigen::Vector3d{0.09, 0.09, 0.03}.asDiagonal();
  std::vector<double> weights;
  double sum = 0.0;
  std::int32_t best = std::numeric_limits<std::int32_t>::max();
  for (Candidate& place : places) {
    place.map_from_robot = refined(field, judges, {place.map_from_robot, loose}, 1.0, sliding).map_from_robot;
    place.misfit = misfit_steps(field, ends, place.map_from_robot);
    best = std::min(best, place.misfit);
  }
  for (const Candidate& place : places) {
    weights.push_back(std::exp(-LikelihoodField::kStep * params.evidence_beams * (place.misfit - best) /
                               static_cast<double>(ends.size())));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;

  std::vector<Pose2> poses;
  poses.reserve(count);
  for (const std::uint32_t chosen : low_variance_choice(weights, count, random.uniform())) {
    const Pose2& place = places[chosen].map_from_robot;
    const double x_m = place.x + random.normal(params.jitter_m);
    const double y_m = place.y + random.normal(params.jitter_m);
    poses.push_back({x_m, y_m, wrapped_angle(place.theta + random.normal(params.jitter_rad))});
  }
  return poses;
}

}  // namespace deltamap::localization
