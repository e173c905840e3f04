// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/straight_faces.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/principal_axes.hpp"

namespace deltamap::mapping::bays {
namespace {

constexpr double kFace_m = 0.6;       // a front of 0.25 m radius is so straight over 0.4 m
constexpr double kMostOff_m = 0.06;   // from the chord: four times the laser's noise
constexpr double kMostRms_m = 0.025;  // from the line; fronts of people side by side are hollow between them
constexpr double kMostGap_m = 0.35;   // between neighbours: two beams of 1° at 10 m
constexpr std::size_t kLeastPoints = 4;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Root mean square distance from the line of least squares.
double roughness_m(std::span<const Point2> points) {
  Point2 mean{0.0, 0.0};
  for (const Point2& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Point2& point : points) scatter += (point - mean) * (point - mean).transpose();
  const double least = principal_axes(scatter).values[0];
  return std::sqrt(std::max(0.0, least) / static_cast<double>(points.size() - 2));
}

void add_faces(std::span<const Point2> ends, std::size_t first, std::size_t last, std::vector<StraightFace>& faces) {
  if (last - first < kLeastPoints) return;
  const Point2 chord = ends[last - 1] - ends[first];
  const double length_m = chord.norm();
  if (length_m < kFace_m) return;
  std::size_t farthest = first;
  double most_m = 0.0;
  for (std::size_t i = first + 1; i + 1 < last; ++i) {
    const double off_m = std::abs(cross(chord, ends[i] - ends[first])) / length_m;
    if (off_m <= most_m) continue;
    most_m = off_m;
    farthest = i;
  }
  if (most_m > kMostOff_m) {
    add_faces(ends, first, farthest + 1, faces);
    add_faces(ends, farthest, last, faces);
  } else if (roughness_m(ends.subspan(first, last - first)) <= kMostRms_m) {
    faces.push_back({first, last});
  }
}

}  // namespace

std::vector<StraightFace> straight_faces(std::span<const Point2> ends) {
  std::vector<StraightFace> faces;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= ends.size(); ++i) {
    if (i < ends.size() && (ends[i] - ends[i - 1]).norm() <= kMostGap_m) continue;
    add_faces(ends, first, i, faces);
    first = i;
  }
  return faces;
}

}  // namespace deltamap::mapping::bays
