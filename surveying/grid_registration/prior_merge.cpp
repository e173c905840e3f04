// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/prior_merge.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/points_in_map.hpp"
#include "core/geometry/pose_spread.hpp"
#include "core/grid/near_occupied.hpp"
#include "mapping/merge/overlay_score.hpp"
#include "mapping/registration/registration.hpp"
#include "mapping/registration/surface.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

constexpr double kSearchStep_m = 0.15;       // well inside the reach of the closest lines
constexpr double kMostSearchPoses = 3000.0;  // coarser steps above
constexpr std::size_t kMostSearchPoints = 80;
constexpr std::size_t kStarts = 4;      // poses of the search that are brought to the end
constexpr double kAmbiguousCost = 6.0;  // above the best one's
constexpr double kApart_m = 0.15;       // starts and answers nearer than this are the same

/// The points about the robot, so that a change of heading turns them about it.
std::vector<Point2> about(const Point2& position_in_map, std::span<const Point2> points_in_map) {
  std::vector<Point2> points;
  points.reserve(points_in_map.size());
  for (const Point2& point : points_in_map) points.emplace_back(point - position_in_map);
  return points;
}

/// How far a turn of 1 rad moves the points, root mean square.
double lever_arm_m(std::span<const Point2> points) {
  double squares = 0.0;
  for (const Point2& point : points) squares += point.squaredNorm();
  return std::max(0.5, std::sqrt(squares / static_cast<double>(points.size())));
}

CellBox box_around(const GridGeometry& geometry, std::span<const Point2> points, double margin_m) {
  Point2 low = points.front();
  Point2 high = low;
  for (const Point2& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Cell last = geometry.cell_at(high);
  const CellBox box{geometry.cell_at(low), {last.column + 1, last.row + 1}};
  return grown(box, static_cast<int>(std::ceil(margin_m / geometry.resolution_m)), geometry);
}

struct PointInMetres {
  float x = 0.0F;
  float y = 0.0F;
};

/// Squared distances to the surface, bounded by the reach, in deviations: -2 ln p of the points at a pose. Those beyond
/// what the map knows count as the others do on average: that they find no surface speaks for no pose.
double misfit(const OccupancyGrid& map, std::span<const Point2> points,
              const mapping::registration::NearestSurface& surface, const Pose2& pose, const PriorMergeParams& params) {
  const double most2 = params.reach_m * params.reach_m;
  const PointsInMap in_map{pose};
  double sum = 0.0;
  std::size_t known = 0;
  for (const Point2& point : points) {
    const Point2 place = in_map(point);
    if (map.at(map.geometry().cell_at(place)) == CellState::kUnknown) continue;
    const mapping::registration::SurfacePoint* nearest = surface.nearest(place);
    sum += nearest == nullptr ? most2 : std::min(most2, (place - nearest->position).squaredNorm());
    ++known;
  }
  const double mean2 = known == 0 ? most2 : sum / static_cast<double>(known);
  return static_cast<double>(points.size()) * mean2 / (params.surface_deviation_m * params.surface_deviation_m);
}

/// The same of a sample, from the middles of the surface's table: quick, and good enough to choose starts.
double rough_misfit(std::span<const PointInMetres> sample, const mapping::registration::NearestSurface& surface,
                    const Pose2& pose, double surface_deviation_m) {
  const auto c = static_cast<float>(std::cos(pose.theta));
  const auto s = static_cast<float>(std::sin(pose.theta));
  const auto x = static_cast<float>(pose.x);
  const auto y = static_cast<float>(pose.y);
  float sum = 0.0F;
  for (const PointInMetres& point : sample) {
    sum += surface.rough_distance2(x + c * point.x - s * point.y, y + s * point.x + c * point.y);
  }
  return static_cast<double>(sum) / (surface_deviation_m * surface_deviation_m);
}

struct Start {
  Pose2 pose;
  double cost = 0.0;
};

/// Poses about the prior's, along its own axes.
struct Lattice {
  Eigen::Matrix3d axes;       ///< columns; the heading in metres at the lever arm
  Eigen::Vector3d variances;  ///< m², along the axes
  double step_m = kSearchStep_m;
  Eigen::Vector3i steps;  ///< each way along the axes
};

double lattice_poses(const Eigen::Vector3d& half_width_m, double step_m) {
  return (2.0 * (half_width_m / step_m).array().floor() + 1.0).prod();
}

Lattice lattice_of(const PoseCovariance& covariance, double lever_m, const PriorMergeParams& params) {
  const Eigen::DiagonalMatrix<double, 3> in_metres{1.0, 1.0, lever_m};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{in_metres * covariance * in_metres};
  Lattice lattice{.axes = solver.eigenvectors(), .variances = solver.eigenvalues(), .steps = {}};
  Eigen::Vector3d half_width_m = params.search_deviations * lattice.variances.cwiseMax(0.0).cwiseSqrt();
  half_width_m = half_width_m.cwiseMin(std::max(params.most_search_m, params.most_search_rad * lever_m));
  while (lattice_poses(half_width_m, lattice.step_m) > kMostSearchPoses) lattice.step_m *= 1.25;
  lattice.steps = (half_width_m / lattice.step_m).array().floor().cast<int>();
  return lattice;
}

/// A step of the lattice, and how much the prior speaks against it.
struct Offset {
  Eigen::Vector3d metres;  ///< x, y, and the heading at the lever arm
  double chi2 = 0.0;
};

std::vector<Offset> plausible_offsets(const Lattice& lattice, double lever_m, const PriorMergeParams& params) {
  const double most_chi2 = 1.8 * params.search_deviations * params.search_deviations;
  const Eigen::Vector3i& steps = lattice.steps;
  std::vector<Offset> offsets;
  for (int i = -steps.x(); i <= steps.x(); ++i) {
    for (int j = -steps.y(); j <= steps.y(); ++j) {
      for (int k = -steps.z(); k <= steps.z(); ++k) {
        const Eigen::Vector3d along = lattice.step_m * Eigen::Vector3i{i, j, k}.cast<double>();
        const double chi2 = along.cwiseAbs2().cwiseQuotient(lattice.variances.cwiseMax(1e-12)).sum();
        if (chi2 > most_chi2) continue;  // a corner of the lattice
        const Eigen::Vector3d offset = lattice.axes * along;
        if (offset.head<2>().norm() > params.most_search_m) continue;
        if (std::abs(offset.z() / lever_m) <= params.most_search_rad) offsets.push_back({offset, chi2});
      }
    }
  }
  return offsets;
}

std::vector<PointInMetres> sample_of(std::span<const Point2> points) {
  std::vector<PointInMetres> sample;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kMostSearchPoints + 1)
    sample.push_back({static_cast<float>(points[i].x()), static_cast<float>(points[i].y())});
  return sample;
}

/// A turn counts as what it moves at the lever arm.
double distance_m(const Pose2& one, const Pose2& other, double lever_m) {
  return std::hypot(distance_between(one, other), lever_m * turn_between(one.theta, other.theta));
}

/// Of starts in order the first ones, each apart from those before it.
std::vector<Start> first_apart(std::span<const Start> starts, double lever_m) {
  std::vector<Start> best;
  for (const Start& start : starts) {
    const bool is_new = std::all_of(best.begin(), best.end(), [&](const Start& better) {
      return distance_m(better.pose, start.pose, lever_m) > 2.0 * kApart_m;
    });
    if (is_new) best.push_back(start);
    if (best.size() == kStarts) break;
  }
  return best;
}

/// The best poses of a lattice along the prior's own axes, best first, each apart from the better ones.
std::vector<Start> search(std::span<const Point2> points, const mapping::registration::NearestSurface& surface,
                          const PosePrior& prior, const PoseCovariance& covariance, double lever_m,
                          const PriorMergeParams& params) {
  const std::vector<PointInMetres> sample = sample_of(points);
  const double shared = mapping::registration::share_of_point(sample.size(), params);
  std::vector<Start> found;
  for (const auto& [offset, chi2] : plausible_offsets(lattice_of(covariance, lever_m, params), lever_m, params)) {
    const Pose2 pose{prior.position_in_map.x() + offset.x(), prior.position_in_map.y() + offset.y(),
                     offset.z() / lever_m};
    found.push_back({pose, shared * rough_misfit(sample, surface, pose, params.surface_deviation_m) + chi2});
  }
  std::sort(found.begin(), found.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; });
  return first_apart(found, lever_m);
}

/// Of the points that lie on known cells; 0 where those are too few.
double agreement(const OccupancyGrid& map, std::span<const Point2> points, const Pose2& pose) {
  std::size_t found = 0;
  std::size_t known = 0;
  for (const Point2& point : points) {
    const Cell cell = map.geometry().cell_at(pose * point);
    const bool near = has_occupied_within(map, cell, 1);
    found += near ? 1 : 0;
    known += near || map.at(cell) != CellState::kUnknown ? 1 : 0;
  }
  return known < mapping::merge::kLeastContour ? 0.0 : static_cast<double>(found) / static_cast<double>(known);
}

/// How far beyond the points, at the guess, the map's surface may count.
double search_margin_m(const PoseCovariance& covariance, const PriorMergeParams& params) {
  return params.reach_m +
         std::min(params.most_search_m, params.search_deviations * std::sqrt(covariance.topLeftCorner<2, 2>().trace()));
}

/// Where a start comes to.
struct End {
  Pose2 pose;
  PriorAnswer answer;
};

End end_of(const Start& start, const OccupancyGrid& map, std::span<const Point2> points,
           const mapping::registration::NearestSurface& surface, const mapping::registration::PoseBelief& belief,
           const PriorMergeParams& params) {
  const mapping::registration::Registration end = mapping::registration::registration(
      points, surface, start.pose, belief,
      mapping::registration::registration_params(points.size(), map.resolution_m(), params));
  const Pose2& guess = belief.pose;
  const Pose2& pose = end.reference_from_moving;
  const Eigen::Vector3d moved{pose.x - guess.x, pose.y - guess.y, pose.theta};
  const double chi2 = moved.dot(belief.information * moved);
  const double shared = mapping::registration::share_of_point(points.size(), params);
  return {pose,
          {.map_from_guess = pose * inverse(guess),
           .covariance = (end.information + belief.information).inverse(),
           .agreement = agreement(map, points, pose),
           .chi2 = chi2,
           .cost = shared * misfit(map, points, surface, pose, params) + chi2}};
}

/// Of ends in order those that are apart from all before them.
std::vector<PriorAnswer> answers_apart(const std::vector<End>& ends, double lever_m) {
  std::vector<PriorAnswer> answers;
  for (auto end = ends.begin(); end != ends.end(); ++end) {
    const bool is_new = std::none_of(
        ends.begin(), end, [&](const End& better) { return distance_m(better.pose, end->pose, lever_m) <= kApart_m; });
    if (is_new) answers.push_back(end->answer);
  }
  return answers;
}

}  // namespace

mapping::merge::MergeRefusal refusal_of(const PriorAnswer& answer, const PriorMergeParams& params) {
  if (answer.agreement < params.least_agreement) return mapping::merge::MergeRefusal::kLowAgreement;
  if (answer.chi2 > kMostChi2) return mapping::merge::MergeRefusal::kImplausible;
  return mapping::merge::MergeRefusal::kNone;
}

std::vector<PriorAnswer> prior_answers(const OccupancyGrid& map, std::span<const Point2> surface_points_in_map_guess,
                                       const PosePrior& prior, const PriorMergeParams& params) {
  if (surface_points_in_map_guess.size() < mapping::merge::kLeastContour) return {};
  const std::vector<Point2> points = about(prior.position_in_map, surface_points_in_map_guess);
  const double lever_m = lever_arm_m(points);
  const PoseCovariance covariance = mapping::registration::floored(prior.covariance, params);
  const CellBox box = box_around(map.geometry(), surface_points_in_map_guess, search_margin_m(covariance, params));
  const mapping::registration::NearestSurface surface{mapping::registration::contour_of(map, box), map.resolution_m(),
                                                      params.reach_m};
  const Pose2 guess{prior.position_in_map.x(), prior.position_in_map.y(), 0.0};
  const mapping::registration::PoseBelief belief{guess, covariance.inverse()};
  std::vector<End> ends;
  for (const Start& start : search(points, surface, prior, covariance, lever_m, params))
    ends.push_back(end_of(start, map, points, surface, belief, params));
  std::stable_sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.answer.cost < b.answer.cost; });
  return answers_apart(ends, lever_m);
}

PriorMerge prior_merge(const OccupancyGrid& map, std::span<const Point2> surface_points_in_map_guess,
                       const PosePrior& prior, const PriorMergeParams& params) {
  const std::vector<PriorAnswer> answers = prior_answers(map, surface_points_in_map_guess, prior, params);
  PriorMerge merge;
  if (answers.empty()) {
    merge.refusal = mapping::merge::MergeRefusal::kTooFewPoints;
    return merge;
  }
  const PriorAnswer& best = answers.front();
  merge.refusal = refusal_of(best, params);
  merge.covariance = best.covariance;
  merge.agreement = best.agreement;
  const bool is_ambiguous = std::any_of(answers.begin() + 1, answers.end(), [&](const PriorAnswer& other) {
    return other.agreement > best.agreement - params.ambiguity_margin && other.cost < best.cost + kAmbiguousCost;
  });
  if (merge.accepted() && is_ambiguous) merge.refusal = mapping::merge::MergeRefusal::kAmbiguous;
  if (merge.accepted()) merge.map_from_guess = best.map_from_guess;
  return merge;
}

}  // namespace deltamap::surveying::grid_registration
