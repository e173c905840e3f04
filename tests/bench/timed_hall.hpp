// SPDX-License-Identifier: Apache-2.0
// The paper's hall (§4, Figure 7) as boxes, on a map of 700 x 700 cells, and a robot that drives round it: exact ranges
// with noise, wheels that drift. What the localizer is timed on; needs nothing but core, so that every build has it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "core/random.hpp"

namespace deltamap::bench {

struct UprightBox {
  Point2 low{0.0, 0.0};
  Point2 high{0.0, 0.0};
};

inline constexpr double kHallSideM = 34.9;

/// Four blocks of 10 x 10 m, each of 16 containers; the corridors are 5 m wide.
inline std::vector<UprightBox> containers() {
  std::vector<UprightBox> boxes;
  for (const double x : {5.0, 20.0}) {
    for (const double y : {5.0, 20.0}) {
      for (int i = 0; i < 16; ++i) {
        const Point2 low{x + 2.5 * (i % 4), y + 2.5 * (i / 4)};
        boxes.push_back({low, low + Point2{2.5, 2.5}});
      }
    }
  }
  return boxes;
}

/// As a survey draws it: surfaces in the middle of their cells, unknown inside the blocks.
inline OccupancyGrid surveyed_hall() {
  constexpr double kCellM = 0.05;
  OccupancyGrid map{{700, 700, kCellM, {-0.5 * kCellM, -0.5 * kCellM}}};
  const auto cell = [](double m) { return static_cast<int>(std::lround(m / kCellM)); };
  const auto paint = [&](const UprightBox& box, CellState surface, CellState inside) {
    for (int row = cell(box.low.y()); row <= cell(box.high.y()); ++row) {
      for (int column = cell(box.low.x()); column <= cell(box.high.x()); ++column) {
        const bool edge = row == cell(box.low.y()) || row == cell(box.high.y()) || column == cell(box.low.x()) ||
                          column == cell(box.high.x());
        map.set({column, row}, edge ? surface : inside);
      }
    }
  };
  paint({{0.0, 0.0}, {kHallSideM, kHallSideM}}, CellState::kOccupied, CellState::kFree);
  for (const double x : {5.0, 20.0}) {
    for (const double y : {5.0, 20.0}) {
      paint({{x, y}, {x + 10.0, y + 10.0}}, CellState::kOccupied, CellState::kUnknown);
    }
  }
  return map;
}

/// Distance along a ray to the first surface; infinite where there is none.
inline double range_in_hall_m(const std::vector<UprightBox>& boxes, const Point2& from, double direction_rad) {
  const Point2 along{std::cos(direction_rad), std::sin(direction_rad)};
  const auto crossings = [&](const UprightBox& box) {
    std::array<double, 2> enter_leave{-std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 2; ++axis) {
      const double one = (box.low[axis] - from[axis]) / along[axis];
      const double other = (box.high[axis] - from[axis]) / along[axis];
      enter_leave[0] = std::max(enter_leave[0], std::min(one, other));
      enter_leave[1] = std::min(enter_leave[1], std::max(one, other));
    }
    return enter_leave;
  };
  double range_m = crossings({{0.0, 0.0}, {kHallSideM, kHallSideM}})[1];
  for (const UprightBox& box : boxes) {
    const auto [enter_m, leave_m] = crossings(box);
    if (enter_m > 0.0 && enter_m < leave_m) range_m = std::min(range_m, enter_m);
  }
  return range_m;
}

struct DriveStep {
  Pose2 truth;
  Odometry odometry;
  Scan scan;
};

/// Laps through the outer corridor, counter-clockwise, at 0.4 m/s and 9.4 scans a second.
class HallLaps {
 public:
  static constexpr double kPeriodS = 0.107;  // 180/1 at 38400 baud (protocols.md B7)
  static constexpr double kSpeedMPerS = 0.4;
  static constexpr double kNoiseM = 0.01;

  explicit HallLaps(double max_range_m, std::uint64_t seed) : max_range_m_{max_range_m}, random_{seed} {}

  [[nodiscard]] static Pose2 start() { return {2.5, 2.5, 0.0}; }

  [[nodiscard]] DriveStep next() {
    if (steps_++ > 0) drive();
    DriveStep step;
    step.truth = truth_;
    step.odometry.time = time();
    step.odometry.odom_from_robot = odom_;
    step.scan = scan();
    return step;
  }

 private:
  [[nodiscard]] Timestamp time() const {
    return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(static_cast<double>(steps_) * kPeriodS);
  }

  void drive() {
    constexpr std::array<Point2 (*)(), 4> kCorners{[] {
                                                     return Point2{32.4, 2.5};
                                                   },
                                                   [] {
                                                     return Point2{32.4, 32.4};
                                                   },
                                                   [] {
                                                     return Point2{2.5, 32.4};
                                                   },
                                                   [] {
                                                     return Point2{2.5, 2.5};
                                                   }};
    if ((kCorners[corner_]() - truth_.position()).norm() < 0.3) corner_ = (corner_ + 1) % kCorners.size();
    const Point2 to = kCorners[corner_]() - truth_.position();
    const double off_rad = turn_between(truth_.theta, std::atan2(to.y(), to.x()));
    const double turn_rad = std::clamp(off_rad, -0.1, 0.1);
    const double forward_m = std::abs(off_rad) > 0.5 ? 0.0 : kSpeedMPerS * kPeriodS;
    truth_ = truth_ * Pose2{forward_m, 0.0, turn_rad};
    const double slip = 1.01 + random_.normal(0.05);
    odom_ = odom_ * Pose2{slip * forward_m, 0.0, 1.02 * turn_rad + 0.02 * forward_m + random_.normal(0.002)};
  }

  [[nodiscard]] Scan scan() {
    Scan scan;
    scan.time = time();
    scan.received = scan.time + duration_from_seconds(0.02);
    scan.number = steps_ - 1;
    scan.first_bearing_rad = -0.5 * std::numbers::pi;
    scan.bearing_step_rad = radians(1.0);
    scan.max_range_m = max_range_m_;
    scan.beams.resize(181);
    for (std::size_t i = 0; i < scan.beams.size(); ++i) {
      const double range_m = range_in_hall_m(boxes_, truth_.position(), truth_.theta + scan.bearing_rad(i));
      scan.beams[i] = {0.0F, 0.0F, BeamKind::kBeyondMaximum};
      if (range_m > max_range_m_) continue;
      scan.beams[i] = {static_cast<float>(range_m + random_.normal(kNoiseM)), 0.0F, BeamKind::kRange};
    }
    return scan;
  }

  std::vector<UprightBox> boxes_ = containers();
  double max_range_m_;
  Random random_;
  Pose2 truth_ = start();
  Pose2 odom_;
  std::size_t corner_ = 0;
  std::uint32_t steps_ = 0;
};

}  // namespace deltamap::bench
