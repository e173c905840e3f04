// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/laser_faults.hpp"

#include "core/geometry/angle.hpp"

namespace deltamap::simulation {
namespace {

Sweep as_mounted(const LaserFaults& faults, Sweep sweep) {
  for (double& bearing_rad : sweep.bearings_rad) {
    bearing_rad = faults.turned_rad + (faults.upside_down ? -bearing_rad : bearing_rad);
  }
  return sweep;
}

Reading within(double range_m, double max_range_m) {
  if (range_m > max_range_m) return {BeamKind::kBeyondMaximum, 0.0};
  return {BeamKind::kRange, range_m};
}

}  // namespace

std::vector<Reading> FaultyLaser::readings(const LaserFaults& faults, const Sweep& sweep, double max_range_m,
                                           const RangeFinder::RobotAt& map_from_robot_at, const Measure& measure) {
  const bool can_repeat = newest_.size() == sweep.bearings_rad.size() && newest_max_range_m_ == max_range_m;
  if (faults.answer == LaserFaults::Answer::kRepeated && can_repeat) return newest_;
  std::vector<Reading> readings = measure(as_mounted(faults, sweep), seen_from(faults, map_from_robot_at));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i] = spoilt(faults, readings[i], sweep.bearings_rad[i], max_range_m);
  }
  newest_ = readings;
  newest_max_range_m_ = max_range_m;
  return readings;
}

RangeFinder::RobotAt FaultyLaser::seen_from(const LaserFaults& faults, const RangeFinder::RobotAt& truth) {
  if (!faults.sees_from_where_it_began) map_from_robot_then_.reset();
  if (faults.sees_from_where_it_began && !map_from_robot_then_) map_from_robot_then_ = truth(0.0);
  return [=, then = map_from_robot_then_, moved = faults.moved_on_map](double offset_s) {
    const Pose2 pose = then ? *then : truth(offset_s);
    return Pose2{pose.x + moved.x, pose.y + moved.y, wrapped_angle(pose.theta + moved.theta)};
  };
}

Reading FaultyLaser::spoilt(const LaserFaults& faults, const Reading& reading, double bearing_rad, double max_range_m) {
  if (bearing_rad >= faults.covered_from_rad && bearing_rad < faults.covered_to_rad) {
    return {faults.covered_answer, faults.covered_answer == BeamKind::kRange ? faults.covered_m : 0.0};
  }
  switch (faults.answer) {
    case LaserFaults::Answer::kMeasured:
    case LaserFaults::Answer::kRepeated:  // of the first scan ever
      break;
    case LaserFaults::Answer::kConstant:
      return within(faults.constant_m, max_range_m);
    case LaserFaults::Answer::kRandom:
      return within(random_.uniform(0.0, faults.random_most_m), max_range_m);
    case LaserFaults::Answer::kBeyondMaximum:
      return {BeamKind::kBeyondMaximum, 0.0};
    case LaserFaults::Answer::kNotValid:
      return {BeamKind::kNotValid, 0.0};
    case LaserFaults::Answer::kDazzled:
      return {BeamKind::kDazzled, 0.0};
    case LaserFaults::Answer::kZero:
      return {BeamKind::kRange, 0.0};
  }
  return reading.kind == BeamKind::kRange ? within(faults.scale * reading.range_m, max_range_m) : reading;
}

}  // namespace deltamap::simulation
