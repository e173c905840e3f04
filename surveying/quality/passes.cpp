// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/passes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace deltamap::surveying::quality {
namespace {

constexpr double kNextScanM = 0.1;
constexpr double kNextScanRad = radians(4.0);
constexpr double kPassM = 3.0;  // a walking robot bends by centimetres on it, and sees each wall several times
constexpr std::uint32_t kMostScans = 60;  // of a robot that turns on the spot

}  // namespace

std::vector<PlacedScan> thinned(std::span<const PlacedScan> scans) {
  std::vector<PlacedScan> kept;
  for (const PlacedScan& scan : scans) {
    if (!kept.empty() && kept.back().drive == scan.drive) {
      const Pose2 moved = motion_between(kept.back().map_from_robot, scan.map_from_robot);
      if (moved.position().norm() < kNextScanM && std::abs(moved.theta) < kNextScanRad) continue;
    }
    kept.push_back(scan);
  }
  return kept;
}

std::vector<Pass> passes_of(std::span<const PlacedScan> scans) {
  std::vector<Pass> passes;
  double way_m = 0.0;
  for (std::uint32_t i = 0; i < scans.size(); ++i) {
    const bool is_same_drive = i > 0 && scans[i - 1].drive == scans[i].drive;
    way_m = is_same_drive ? way_m + distance_between(scans[i - 1].map_from_robot, scans[i].map_from_robot) : 0.0;
    if (!is_same_drive || way_m - passes.back().began_m > kPassM || i - passes.back().first >= kMostScans) {
      passes.push_back({i, i, scans[i].drive, way_m, way_m, {0.0, 0.0}});
    }
    Pass& pass = passes.back();
    pass.last = i;
    pass.ended_m = way_m;
    pass.middle += (scans[i].map_from_robot.position() - pass.middle) / (i - pass.first + 1);
  }
  return passes;
}

double way_between(const Pass& a, const Pass& b) {
  if (a.drive != b.drive) return std::numeric_limits<double>::infinity();
  return std::max({0.0, b.began_m - a.ended_m, a.began_m - b.ended_m});
}

}  // namespace deltamap::surveying::quality
