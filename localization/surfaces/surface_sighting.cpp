// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_sighting.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::surfaces {
namespace {

constexpr double kChordM = 0.2;       // between the neighbours that give an end its direction, at least
constexpr std::size_t kFarthest = 8;  // beams to either side
constexpr double kOnTheLineM = 0.04;  // an end from the chord of its neighbours
constexpr std::size_t kFewestBeams = 3;
constexpr double kTogetherM = 0.12;  // of their median
constexpr double kTogetherShare = 0.4;

}  // namespace

std::vector<FacedEnd> faced_ends(const Scan& scan, std::span<const RayInRobot> rays, std::vector<FacedEnd> ends) {
  ends.clear();
  const auto valid = [&](std::size_t i) { return scan.beams[i].kind == BeamKind::kRange; };
  const auto end = [&](std::size_t i) { return Point2{rays[i].end.cast<double>()}; };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!valid(i)) continue;
    FacedEnd faced{end(i), {0.0, 0.0}};
    for (std::size_t k = 1; k <= kFarthest && k <= i && i + k < rays.size(); ++k) {
      if (!valid(i - k) || !valid(i + k)) continue;
      const Point2 chord = end(i + k) - end(i - k);
      const double length_m = chord.norm();
      if (length_m < kChordM) continue;
      Point2 normal{-chord.y() / length_m, chord.x() / length_m};
      if (std::abs(normal.dot(faced.at - end(i - k))) > kOnTheLineM) break;
      if (normal.dot(Point2{rays[i].origin.cast<double>()} - faced.at) < 0.0) normal = -normal;
      faced.normal = normal;
      break;
    }
    ends.push_back(faced);
  }
  return ends;
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

void SightingFinder::begin() {
  claims_used_ = 0;
  sightings_.clear();
  rest_.x_m.clear();
  rest_.y_m.clear();
}

void SightingFinder::claim(const Candidate& candidate, double residual_m, std::uint32_t end) {
  std::size_t at = 0;
  while (at < claims_used_ && !(claims_[at].id == candidate.id)) ++at;
  if (at == claims_used_) {
    if (at == claims_.size()) claims_.emplace_back();
    claims_[at].id = candidate.id;
    claims_[at].surface = candidate.surface;
    claims_[at].ends.clear();
    claims_[at].residuals_m.clear();
    ++claims_used_;
  }
  claims_[at].ends.push_back(end);
  claims_[at].residuals_m.push_back(static_cast<float>(residual_m));
}

void SightingFinder::judge(std::span<const FacedEnd> ends) {
  std::vector<float> sorted;
  for (std::size_t at = 0; at < claims_used_; ++at) {
    const Claim& claim = claims_[at];
    if (claim.ends.size() < kFewestBeams) continue;
    sorted = claim.residuals_m;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const float median = *middle;
    Sighting seen{.id = claim.id, .surface = claim.surface};
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
