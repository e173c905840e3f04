// SPDX-License-Identifier: Apache-2.0
// What a laser answers wrongly, on order, while its telegrams, their times and their counters go on as they should.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/messages.hpp"
#include "core/random.hpp"
#include "simulation/robot/range_finder.hpp"

namespace deltamap::simulation {

/// Everything at its default: nothing is wrong.
struct LaserFaults {
  /// What all beams answer.
  enum class Answer : std::uint8_t {
    kMeasured,
    kRepeated,  ///< the newest scan from before, to the last digit
    kConstant,
    kRandom,  ///< each beam a range of its own
    kBeyondMaximum,
    kNotValid,
    kDazzled,
    kZero  ///< the number 0
  };
  Answer answer = Answer::kMeasured;
  double constant_m = 5.0;      ///< kConstant, > 0
  double random_most_m = 10.0;  ///< kRandom, > 0

  double turned_rad = 0.0;   ///< of the fan against its mount, counter-clockwise
  bool upside_down = false;  ///< its left is its right
  double scale = 1.0;        ///< of every range, > 0

  // A part of the fan that is covered: bearings in the laser frame, from the right one to the left one.
  double covered_from_rad = 0.0;
  double covered_to_rad = 0.0;
  BeamKind covered_answer = BeamKind::kBeyondMaximum;  ///< kRange: that it ends covered_m away
  double covered_m = 0.05;

  // Where it looks from.
  bool sees_from_where_it_began = false;  ///< from where it was when this began, with its usual noise
  Pose2 moved_on_map{};                   ///< it stands where x, y and heading are that much more than the robot's

  friend bool operator==(const LaserFaults&, const LaserFaults&) = default;
};

class FaultyLaser {
 public:
  explicit FaultyLaser(Random random) : random_{random} {}

  using Measure = std::function<std::vector<Reading>(const Sweep&, const RangeFinder::RobotAt&)>;
  /// One sweep by a range finder, as it comes out with these faults.
  [[nodiscard]] std::vector<Reading> readings(const LaserFaults& faults, const Sweep& sweep, double max_range_m,
                                              const RangeFinder::RobotAt& map_from_robot_at, const Measure& measure);

 private:
  [[nodiscard]] RangeFinder::RobotAt seen_from(const LaserFaults& faults, const RangeFinder::RobotAt& truth);
  [[nodiscard]] Reading spoilt(const LaserFaults& faults, const Reading& reading, double bearing_rad,
                               double max_range_m);

  Random random_;
  std::vector<Reading> newest_;
  double newest_max_range_m_ = 0.0;
  std::optional<Pose2> map_from_robot_then_;  // since it sees from there
};

}  // namespace deltamap::simulation
