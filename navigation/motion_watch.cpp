// SPDX-License-Identifier: Apache-2.0
#include "navigation/motion_watch.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::navigation {
namespace {

constexpr double kWayM = 0.25;  // driven, or turned, from one reference to the next
constexpr double kWayRad = 0.2;
constexpr double kWayMostS = 6.0;
constexpr double kCreepWayM = 0.1;    // from here on a robot that creeps is judged,
constexpr double kCreepStepM = 0.03;  // again and again,
constexpr double kSlowMPerS = 0.15;   // which is slower than that
constexpr double kSlowRadPerS = 0.25;
constexpr double kSilenceS = 5.0;       // of a laser: it may have been taken off, and put on otherwise
constexpr double kNothingToAskM = 1.0;  // then it is no worse than a laser in a corridor at any time
constexpr int kFewestAsked = 15;
constexpr double kShownAtLeast = 0.6;   // of what is asked shows another motion,
constexpr double kMoreThanTold = 0.4;   // and so much more than shows what the wheels tell; or the reverse
constexpr int kContradictions = 2;      // in a row: one may be chance,
constexpr int kClearAsked = 30;         // but not where so many ends
constexpr double kCreepMore = 0.25;     // of a robot that creeps: hardly anything else lets ranges differ
constexpr double kClearlyMore = 0.6;    // show it so clearly
constexpr double kLittleAsTold = 0.25;  // the robot has moved otherwise, whatever that was

bool is_a_way(const Pose2& motion, double distance_m) {
  return std::hypot(motion.x, motion.y) >= distance_m || std::abs(motion.theta) >= kWayRad;
}

}  // namespace

bool MotionWatch::contradicts_wheels() const { return contradictions_ >= kContradictions; }

/// The same laser on the same mount, and wheels that can be compared.
bool MotionWatch::goes_on(const Moment& now) const {
  return last_ && last_->epoch == now.epoch && last_->robot_from_laser == now.robot_from_laser &&
         seconds(now.time - last_->time) < kSilenceS;
}

void MotionWatch::skip() {
  reference_.reset();
  judged_m_ = 0.0;
}

void MotionWatch::forget_contradiction() {
  contradictions_ = 0;
  skip();
}

void MotionWatch::doubt() {
  skip();
  looks_ahead_ = false;
  unproven_m_ = 0.0;
}

/// So that wheels and scans cannot be late by more than a centimetre or two, or degrees.
bool MotionWatch::is_slow(const Moment& now) const {
  const Pose2 step = motion_between(last_->odom_from_robot, now.odom_from_robot);
  const double step_s = seconds(now.time - last_->time);
  return step.position().norm() < kSlowMPerS * step_s && std::abs(step.theta) < kSlowRadPerS * step_s;
}

void MotionWatch::observe(const Scan& scan, const Pose2& odom_from_robot, std::uint32_t epoch) {
  const Moment now{scan.time, scan.robot_from_laser, odom_from_robot, epoch};
  bool creeps = false;
  if (goes_on(now)) {
    unproven_m_ += distance_between(last_->odom_from_robot, odom_from_robot);
    creeps = !looks_ahead_ && is_slow(now);
  } else {
    doubt();
  }
  const bool is_old = reference_ && seconds(scan.time - reference_->scan.time) >= kWayMostS;
  const bool slows_down = reference_ && creeps && !reference_->creeps;
  if (is_old || slows_down) skip();
  if (reference_) reference_->creeps = creeps;
  if (reference_) compare(scan, odom_from_robot);
  if (!reference_) reference_ = Reference{scan, odom_from_robot, creeps};
  if (unproven_m_ >= kNothingToAskM && contradictions_ == 0) looks_ahead_ = true;
  last_ = now;
}

void MotionWatch::compare(const Scan& scan, const Pose2& odom_from_robot) {
  const Pose2 motion = motion_between(reference_->odom_from_robot, odom_from_robot);
  const bool creeps = reference_->creeps;
  if (!is_a_way(motion, creeps ? std::max(kCreepWayM, judged_m_ + kCreepStepM) : kWayM)) return;
  const ShownMotion shown = shown_motion(reference_->scan, scan, motion, creeps ? Likeness::creeping() : Likeness{});
  judged_m_ = motion.position().norm();
  if (is_a_way(motion, kWayM)) skip();
  judge(shown, creeps ? kCreepMore : kMoreThanTold);
}

void MotionWatch::judge(const ShownMotion& shown, double least_more) {
  if (shown.asked < kFewestAsked) return;
  const double otherwise = std::max(shown.otherwise, shown.askew);
  const double more = otherwise - shown.as_told;
  const bool shows_otherwise = otherwise >= kShownAtLeast && more >= least_more;
  const bool shows_neither = shown.asked >= kClearAsked && shown.as_told < kLittleAsTold;
  const bool is_clear = shown.asked >= kClearAsked && more >= kClearlyMore;
  if (!shows_otherwise && !shows_neither)
    contradictions_ = 0;
  else
    contradictions_ += is_clear ? kContradictions : 1;
  if (contradicts_wheels() || shows_neither) doubt();
  if (shown.as_told >= kShownAtLeast && shown.as_told >= shown.otherwise + least_more) looks_ahead_ = true;
}

}  // namespace deltamap::navigation
