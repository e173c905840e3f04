// SPDX-License-Identifier: Apache-2.0
// A drive in passes: stretches so short that its scans agree with each other whatever the map is worth. Each pass is a
// witness; what tells a false map is that witnesses of different times contradict each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "localization/motion/packed_scan.hpp"

namespace deltamap::surveying::quality {

/// A scan, and where the map has it.
struct PlacedScan {
  const localization::motion::PackedScan* scan = nullptr;
  Pose2 map_from_robot;
  std::uint32_t drive = 0;  ///< which of the drives it belongs to
};

/// Scans `first` to `last`, both included, all of one drive.
struct Pass {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  std::uint32_t drive = 0;
  double began_m = 0.0;  ///< along the drive
  double ended_m = 0.0;
  Point2 middle{0.0, 0.0};  ///< of the robot's places, map frame
};

/// Of scans in order of time, drive by drive: those that stand a decimetre or some degrees on from the one before.
[[nodiscard]] std::vector<PlacedScan> thinned(std::span<const PlacedScan> scans);

[[nodiscard]] std::vector<Pass> passes_of(std::span<const PlacedScan> scans);

/// Way of the drive between two passes, m; infinite for different drives.
[[nodiscard]] double way_between(const Pass& a, const Pass& b);

}  // namespace deltamap::surveying::quality
