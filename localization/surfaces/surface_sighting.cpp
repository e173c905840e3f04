// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_sighting.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::surfaces {
namespace {

constexpr std::size_t kFewestBeams = 3;
constexpr double kTogetherM = 0.12;  // of their median
constexpr double kTogetherShare = 0.4;

}  // namespace

bool sighting::is_on_contour(const sensor::LikelihoodField& field, const Point2& at) {
  const double off_m = field.distance_of_steps_m()[field.steps_at(field.geometry().cell_at(at))];
  return off_m <= kExplainedCells * field.geometry().resolution_m;
}

bool sighting::ends_face(const sensor::LikelihoodField& field, const Point2& at, const Point2& outward) {
  const Point2 explained = kExplainedCells * field.geometry().resolution_m * outward;
  return is_on_contour(field, at - explained) && !is_on_contour(field, at + 2.0 * explained);
}

Sighting::Measured Sighting::measured(const Pose2& pose) const {
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  const Point2 lever{c * mean.x() - s * mean.y(), s * mean.x() + c * mean.y()};
  const Point2 from = lever + pose.position() - surface.centre;
  const Point2 tangent = surface.tangent();
  // The surface's axes as the robot sees them.
  const Point2 n{c * surface.normal.x() + s * surface.normal.y(), -s * surface.normal.x() + c * surface.normal.y()};
  const Point2 t{c * tangent.x() + s * tangent.y(), -s * tangent.x() + c * tangent.y()};
  const double along2 = t.dot(scatter * t);
  return {
      .distance_m = surface.normal.dot(from),
      .along_m = tangent.dot(from),
      .slope = along2 > 0.0 ? n.dot(scatter * t) / along2 : 0.0,
      .spread_m2 = along2,
      .across_m2 = std::max(0.0, n.dot(scatter * n) - (along2 > 0.0 ? std::pow(n.dot(scatter * t), 2) / along2 : 0.0)),
      .lever = lever};
}

std::vector<SupportingFace> supporting_faces(std::span<const Sighting> sightings, const Pose2& map_from_robot,
                                             double within_m) {
  std::vector<const Surface*> surfaces;
  std::vector<SupportingFace> faces;
  for (const Sighting& seen : sightings) {
    const double off_m = seen.measured(map_from_robot).distance_m;
    if (seen.corner_deviation_m > 0.0 || std::abs(off_m) > within_m) continue;
    surfaces.push_back(&seen.surface);
    faces.push_back({.normal = seen.surface.normal, .cells_m = seen.surface.offset_deviation_m, .off_m = off_m});
  }
  const std::vector<std::size_t> body =
      bodies(faces.size(), [&](std::size_t a, std::size_t b) { return are_one_face(*surfaces[a], *surfaces[b]); });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    faces[i].weight = 1.0 / static_cast<double>(std::count(body.begin(), body.end(), body[i]));
  }
  return faces;
}

void SightingFinder::begin(std::size_t ends) {
  claims_used_ = 0;
  sightings_.clear();
  is_taken_.assign(ends, 0);
  rest_.x_m.clear();
  rest_.y_m.clear();
}

void SightingFinder::claim(const Match& match, std::uint32_t end) {
  std::size_t at = 0;
  while (at < claims_used_ && !(claims_[at].id == match.id)) ++at;
  if (at == claims_used_) {
    if (at == claims_.size()) claims_.emplace_back();
    claims_[at].id = match.id;
    claims_[at].surface = match.surface;
    claims_[at].ends.clear();
    claims_[at].residuals_m.clear();
    ++claims_used_;
  }
  claims_[at].ends.push_back(end);
  claims_[at].residuals_m.push_back(static_cast<float>(match.residual_m));
}

/// Beams on the surface tell more than a corner; of two corners the sharper one counts.
void SightingFinder::add(const Match& match, const Corner& corner, double range_deviation_m) {
  const Sighting seen{.id = match.id,
                      .surface = match.surface,
                      .beams = 1.0,
                      .mean = corner.at,
                      .range_deviation_m = range_deviation_m,
                      .corner_deviation_m = corner.deviation_m};
  const auto known =
      std::find_if(sightings_.begin(), sightings_.end(), [&](const Sighting& other) { return other.id == match.id; });
  if (known == sightings_.end()) {
    sightings_.push_back(seen);
  } else if (known->corner_deviation_m > corner.deviation_m) {
    *known = seen;
  }
}

void SightingFinder::judge(const FacedScan& scan) {
  const std::span<const FacedEnd> ends = scan.ends;
  rest_.range_deviation_m = scan.range_deviation_m;
  std::vector<float> sorted;
  for (std::size_t at = 0; at < claims_used_; ++at) {
    const Claim& claim = claims_[at];
    if (claim.ends.size() < kFewestBeams) continue;
    sorted = claim.residuals_m;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const float median = *middle;
    Sighting seen{.id = claim.id, .surface = claim.surface, .range_deviation_m = scan.range_deviation_m};
    for (std::size_t i = 0; i < claim.ends.size(); ++i) {
      if (std::abs(claim.residuals_m[i] - median) > kTogetherM) continue;
      seen.beams += 1.0;
      seen.mean += ends[claim.ends[i]].at;
    }
    if (seen.beams < static_cast<double>(kFewestBeams) ||
        seen.beams < kTogetherShare * static_cast<double>(claim.ends.size())) {
      continue;
    }
    seen.mean /= seen.beams;
    for (std::size_t i = 0; i < claim.ends.size(); ++i) {
      if (std::abs(claim.residuals_m[i] - median) > kTogetherM) continue;
      const Point2 off = ends[claim.ends[i]].at - seen.mean;
      seen.scatter += off * off.transpose();
      is_taken_[claim.ends[i]] = 1;
    }
    sightings_.push_back(seen);
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (is_taken_[i] != 0) continue;
    rest_.x_m.push_back(static_cast<float>(ends[i].at.x()));
    rest_.y_m.push_back(static_cast<float>(ends[i].at.y()));
  }
}

}  // namespace deltamap::localization::surfaces
