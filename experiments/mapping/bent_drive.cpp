// SPDX-License-Identifier: Apache-2.0
#include "experiments/mapping/bent_drive.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "mapping/registration/surface.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kWallCellM = 0.2;
constexpr double kApartM = 0.3;
constexpr double kLongestM = 25.0;

std::vector<Pose2> slightly_off(const std::vector<Pose2>& truth, Random& random) {
  std::vector<Pose2> poses;
  Pose2 off;
  for (const Pose2& pose : truth) {
    off = {0.97 * off.x + random.normal(0.005), 0.97 * off.y + random.normal(0.005),
           0.97 * off.theta + random.normal(radians(0.07))};
    poses.push_back({pose.x + off.x, pose.y + off.y, wrapped_angle(pose.theta + off.theta)});
  }
  return poses;
}

/// Driven up to each scan, over all drives.
std::vector<double> way_of(const DrivenScans& driven) {
  std::vector<double> way(driven.truth.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i) {
    const bool is_same = driven.drive[i] == driven.drive[i - 1];
    way[i] = way[i - 1] + (is_same ? distance_between(driven.truth[i - 1], driven.truth[i]) : 0.0);
  }
  return way;
}

Pose2 turn_about(const Point2& centre, double turn_rad) {
  return Pose2{centre.x(), centre.y(), turn_rad} * Pose2{-centre.x(), -centre.y(), 0.0};
}

double either_side(Random& random) { return random.uniform() < 0.5 ? -1.0 : 1.0; }

/// A scan between these shares of the way.
std::size_t scan_within(const std::vector<double>& way, double low, double high, Random& random) {
  const double at_m = random.uniform(low, high) * way.back();
  const auto place = std::lower_bound(way.begin(), way.end(), at_m);
  return std::min(way.size() - 1, static_cast<std::size_t>(place - way.begin()));
}

void kink(std::vector<Pose2>& poses, const DrivenScans& driven, const std::vector<double>& way, Random& random) {
  const double turn = radians(random.uniform(3.0, 20.0)) * either_side(random);
  const double within_m = random.uniform(0.1, 2.0);
  const std::size_t first = scan_within(way, 0.15, 0.85, random);
  const Point2 centre = poses[first].position();
  for (std::size_t i = first; i < poses.size() && driven.drive[i] == driven.drive[first]; ++i) {
    poses[i] = turn_about(centre, turn * std::min(1.0, (way[i] - way[first]) / within_m)) * poses[i];
  }
}

void scale(std::vector<Pose2>& poses, Random& random) {
  const double factor = 1.0 + 0.03 * either_side(random);
  for (Pose2& pose : poses) pose = {factor * pose.x, factor * pose.y, pose.theta};
}

void shift(std::vector<Pose2>& poses, const std::vector<double>& way, Random& random) {
  const double length_m = random.uniform(6.0, 20.0);
  const double ramp_m = random.uniform(0.3, 3.0);
  const double direction = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double off_m = random.uniform(0.5, 2.0);
  const double begin_m = way[scan_within(way, 0.1, 0.8, random)];
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double share =
        std::clamp(std::min((way[i] - begin_m) / ramp_m, (begin_m + length_m - way[i]) / ramp_m), 0.0, 1.0);
    poses[i].x += share * off_m * std::cos(direction);
    poses[i].y += share * off_m * std::sin(direction);
  }
}

void alias(std::vector<Pose2>& poses, const DrivenScans& driven, const std::vector<double>& way, Random& random) {
  const double ramp_m = random.uniform(2.0, 8.0);
  const double direction = 0.5 * std::numbers::pi * random.index_below(4);
  const double off_m = random.uniform(3.0, 15.0);
  const std::size_t first = scan_within(way, 0.3, 0.7, random);
  for (std::size_t i = first; i < poses.size() && driven.drive[i] == driven.drive[first]; ++i) {
    const double share = std::min(1.0, (way[i] - way[first]) / ramp_m);
    poses[i].x += share * off_m * std::cos(direction);
    poses[i].y += share * off_m * std::sin(direction);
  }
}

void mirror(std::vector<Pose2>& poses, const DrivenScans& driven) {
  Point2 low = poses.front().position();
  Point2 high = low;
  for (const Pose2& pose : poses) {
    low = low.cwiseMin(pose.position());
    high = high.cwiseMax(pose.position());
  }
  const Pose2 half_a_turn = turn_about(0.5 * (low + high), std::numbers::pi);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (driven.drive[i] > 0) poses[i] = half_a_turn * poses[i];
  }
}

}  // namespace

std::string_view name_of(Bend bend) {
  switch (bend) {
    case Bend::kNone:
      return "none";
    case Bend::kKink:
      return "kink";
    case Bend::kScale:
      return "scale";
    case Bend::kShift:
      return "shift";
    case Bend::kAlias:
      return "alias";
    case Bend::kMirrored:
      return "mirrored";
  }
  return "";
}

std::vector<Pose2> bent(Bend bend, const DrivenScans& driven, Random& random) {
  std::vector<Pose2> poses = slightly_off(driven.truth, random);
  const std::vector<double> way = way_of(driven);
  if (bend == Bend::kKink) kink(poses, driven, way, random);
  if (bend == Bend::kScale) scale(poses, random);
  if (bend == Bend::kShift) shift(poses, way, random);
  if (bend == Bend::kAlias) alias(poses, driven, way, random);
  if (bend == Bend::kMirrored) mirror(poses, driven);
  return poses;
}

std::vector<surveying::quality::PlacedScan> placed_at(const DrivenScans& driven, const std::vector<Pose2>& poses) {
  std::vector<surveying::quality::PlacedScan> placed;
  for (std::size_t i = 0; i < poses.size(); ++i) placed.push_back({&driven.scans[i], poses[i], driven.drive[i]});
  return placed;
}

double doubled_wall_m(const DrivenScans& driven, const std::vector<Pose2>& poses) {
  using Place = std::pair<int, int>;
  struct Mean {
    double sum_m = 0.0;
    int count = 0;
  };
  std::map<Place, std::pair<double, double>> drawn;  // least and most, off the truth, of all passes
  for (const surveying::quality::Pass& pass : surveying::quality::passes_of(placed_at(driven, poses))) {
    std::map<Place, Mean> off;
    for (std::uint32_t k = pass.first; k <= pass.last; ++k) {
      for (const auto& point : mapping::registration::surface_of(driven.scans[k].ends(kLongestM))) {
        const Point2 place = driven.truth[k] * point.position;
        Point2 normal = Pose2{0.0, 0.0, driven.truth[k].theta} * point.normal;
        if (normal.x() + 0.3 * normal.y() < 0.0) normal = -normal;  // one side for all
        Mean& mean = off[{static_cast<int>(std::floor(place.x() / kWallCellM)),
                          static_cast<int>(std::floor(place.y() / kWallCellM))}];
        mean.sum_m += normal.dot(poses[k] * point.position - place);
        ++mean.count;
      }
    }
    for (const auto& [place, mean] : off) {
      if (mean.count < 2) continue;
      const double off_m = mean.sum_m / mean.count;
      const auto [range, is_new] = drawn.try_emplace(place, off_m, off_m);
      range->second = {std::min(range->second.first, off_m), std::max(range->second.second, off_m)};
    }
  }
  return kWallCellM * static_cast<double>(std::count_if(drawn.begin(), drawn.end(), [](const auto& cell) {
           return cell.second.second - cell.second.first > kApartM;
         }));
}

}  // namespace deltamap::experiments
