// SPDX-License-Identifier: Apache-2.0
// A drive through a drawn hall at its true poses, or at others: for tests of map quality.
#pragma once

#include <vector>

#include "surveying/quality/passes.hpp"
#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::test {

struct PlacedDrive {
  std::vector<localization::motion::PackedScan> scans;
  std::vector<surveying::quality::PlacedScan> placed;

  PlacedDrive(const OccupancyGrid& hall, const std::vector<Pose2>& way) {
    Random random{7};
    for (const TrackedScan& seen : surveyed(hall, way, random)) scans.emplace_back(seen.scan);
    for (std::size_t i = 0; i < way.size(); ++i) placed.push_back({&scans[i], way[i], 0});
  }
  PlacedDrive(const PlacedDrive&) = delete;
  PlacedDrive& operator=(const PlacedDrive&) = delete;

  /// From the one scan to before the other, moved by so much in the map.
  PlacedDrive& move(std::size_t first, std::size_t last, const Pose2& by) {
    for (std::size_t i = first; i < last; ++i) placed[i].map_from_robot = by * placed[i].map_from_robot;
    return *this;
  }
};

}  // namespace deltamap::test
