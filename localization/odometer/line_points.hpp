// SPDX-License-Identifier: Apache-2.0
// The ends of a scan's beams with the line that each lies on: the direction of the surface that a beam met, from the
// beams beside it. A line through many ends is known far better than one end, so each end is moved onto its line.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::localization::odometer {

/// The view of a laser in equal parts: a single person hides one or two.
inline constexpr std::size_t kSectors = 16;

/// The end of a beam, robot frame at Scan::time.
struct LinePoint {
  Eigen::Vector2f at{0.0F, 0.0F};      ///< m; on the line, where there is one
  Eigen::Vector2f normal{0.0F, 0.0F};  ///< towards the laser, unit vector; zero where the ends beside it make no line
  std::uint8_t sector = 0;             ///< of the laser's view, in which it was seen; below kSectors
  [[nodiscard]] bool has_line() const { return normal.x() != 0.0F || normal.y() != 0.0F; }
};

class LinePointFinder {
 public:
  /// One point a beam that came back, in the order of the beams. `rays`: the scan's, without the robot's own motion
  /// (motion/deskew.hpp). Valid until the next call.
  [[nodiscard]] std::span<const LinePoint> points_of(const Scan& scan, std::span<const RayInRobot> rays);

 private:
  /// Sums over all ends before one: those over any row of ends are a difference.
  struct Sums {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  };
  struct End {
    std::size_t beam = 0;
    std::size_t first = 0;  // of the ends that are connected with it
    std::size_t past = 0;
  };
  void gather(const Scan& scan, std::span<const RayInRobot> rays);

  std::vector<End> ends_;
  std::vector<Sums> sums_;
  std::vector<LinePoint> points_;
};

}  // namespace deltamap::localization::odometer
