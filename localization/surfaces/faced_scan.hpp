// SPDX-License-Identifier: Apache-2.0
// What one scan shows of straight faces: the ends of its beams with the direction of the face that they lie on, and the
// corners where a face ends and the next beams pass by.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::localization::surfaces {

/// The end of a beam, robot frame.
struct FacedEnd {
  Point2 at{0.0, 0.0};
  Point2 normal{0.0, 0.0};  ///< towards the laser; zero where the neighbouring ends do not lie on a line with it
};

/// Where a face ends, robot frame. It tells where the face around the corner stands, which no beam meets.
struct Corner {
  Point2 at{0.0, 0.0};
  Point2 outward{0.0, 0.0};  ///< along the face that is in view, unit vector: the normal of the one around the corner
  double deviation_m = 0.0;  ///< along `outward`: it lies anywhere between the last beam and the next
};

/// One scan; views of what is kept elsewhere.
struct FacedScan {
  std::span<const FacedEnd> ends;
  std::span<const Corner> corners{};
  double range_deviation_m = kRangeDeviationM;  ///< Scan::range_deviation_m
};

/// `rays`: the scan's, without the robot's own motion (deskew.hpp). `reused`: its memory is.
[[nodiscard]] std::vector<FacedEnd> faced_ends(const Scan& scan, std::span<const RayInRobot> rays,
                                               std::vector<FacedEnd> reused = {});
[[nodiscard]] std::vector<Corner> corners_of(const Scan& scan, std::span<const RayInRobot> rays,
                                             std::vector<Corner> reused = {});

/// Finds them when they are first asked for: between keyframes nobody asks.
class FaceFinder {
 public:
  using Keeps = std::function<bool(const Point2& end)>;

  /// The next scan. Both must live for as long as its faces are asked for.
  void begin(const Scan& scan, std::span<const RayInRobot> rays);
  /// Leaves out ends and corners, robot frame, for which `keeps` answers false.
  void keep(Keeps keeps) { keeps_ = std::move(keeps); }
  /// Valid until the next scan begins; empty before the first.
  [[nodiscard]] FacedScan faces();

 private:
  const Scan* scan_ = nullptr;
  std::span<const RayInRobot> rays_;
  Keeps keeps_;
  bool found_ = false;
  std::vector<FacedEnd> ends_;
  std::vector<Corner> corners_;
};

}  // namespace deltamap::localization::surfaces
