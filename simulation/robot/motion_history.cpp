// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/motion_history.hpp"

#include <algorithm>
#include <cassert>

namespace deltamap::simulation {
namespace {

constexpr Duration kKept = std::chrono::milliseconds{500};

}  // namespace

void MotionHistory::add(Moment moment) {
  assert((moments_.empty() || moments_.back().time < moment.time) && "moments come in order");
  moments_.push_back(std::move(moment));
  while (moments_.back().time - moments_.front().time > kKept) moments_.pop_front();
}

MotionHistory::Between MotionHistory::around(Timestamp time) const {
  assert(!moments_.empty() && "there is a first moment");
  const auto after = std::lower_bound(moments_.begin(), moments_.end(), time,
                                      [](const Moment& moment, Timestamp t) { return moment.time < t; });
  if (after == moments_.begin()) return {&*after, &*after, 0.0};
  if (after == moments_.end()) return {&moments_.back(), &moments_.back(), 0.0};
  const auto before = std::prev(after);
  return {&*before, &*after, seconds(time - before->time) / seconds(after->time - before->time)};
}

Pose2 MotionHistory::map_from_robot_at(Timestamp time) const {
  const Between moments = around(time);
  return interpolated(moments.before->map_from_robot, moments.after->map_from_robot, moments.share);
}

devices::WheelMotion MotionHistory::wheels_at(Timestamp time) const {
  const Between moments = around(time);
  devices::WheelMotion wheels = moments.after->wheels;
  wheels.odom_from_robot = interpolated(moments.before->wheels.odom_from_robot, wheels.odom_from_robot, moments.share);
  return wheels;
}

const Bodies& MotionHistory::bodies_at(Timestamp time) const { return around(time).after->bodies; }

}  // namespace deltamap::simulation
