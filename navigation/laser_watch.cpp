// SPDX-License-Identifier: Apache-2.0
#include "navigation/laser_watch.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/shown_motion.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kBlindS = 1.0;                 // without a range: a person who steps close takes no longer
constexpr double kFewShare = 0.03;              // of the beams: fewer ranges are none
constexpr double kExcuseLifeS = 0.5;            // until the localizer must say so again
constexpr double kNeighbourS = 0.5;             // scans further apart tell nothing of what broke off at once
constexpr double kCoveredShare = 1.0 / 6.0;     // of the fan that loses its ranges from one scan to the next
constexpr double kUncoveredShare = 1.0 / 12.0;  // less than that of the fan is left without: it is open again
constexpr std::size_t kFewestAlike = 10;        // ranges; fewer could be the same by chance
constexpr double kAlikeM = 0.1;                 // driven, or turned, while scans are the same: none can be
constexpr double kAlikeRad = radians(5.0);
constexpr double kWayM = 0.25;  // driven, or turned, between two scans that are compared
constexpr double kWayRad = 0.2;
constexpr double kWayMostS = 6.0;
constexpr int kFewestAsked = 15;
constexpr double kShownAtLeast = 0.6;   // of what is asked shows another motion,
constexpr double kMoreThanTold = 0.4;   // and so much more than shows what the wheels tell
constexpr int kContradictions = 2;      // in a row: one may be chance,
constexpr int kClearAsked = 30;         // but not where so many ends
constexpr double kClearlyMore = 0.6;    // show it so clearly
constexpr double kLittleAsTold = 0.25;  // the robot has moved otherwise, whatever that was

std::size_t ranges_in(const Scan& scan) {
  return static_cast<std::size_t>(std::count_if(scan.beams.begin(), scan.beams.end(),
                                                [](const Beam& beam) { return beam.kind == BeamKind::kRange; }));
}

bool are_alike(const Scan& one, const Scan& other) {
  return std::equal(one.beams.begin(), one.beams.end(), other.beams.begin(), other.beams.end(),
                    [](const Beam& a, const Beam& b) { return a.kind == b.kind && a.range_m == b.range_m; });
}

bool is_a_way(const Pose2& motion, double distance_m, double turn_rad) {
  return std::hypot(motion.x, motion.y) >= distance_m || std::abs(motion.theta) >= turn_rad;
}

}  // namespace

bool brings_nothing(const Scan& scan) {
  return static_cast<double>(ranges_in(scan)) < std::max(1.0, kFewShare * static_cast<double>(scan.beams.size()));
}

// --- a covered sector ---

void CoveredSector::observe(const Scan& scan) {
  const std::size_t count = scan.beams.size();
  const bool follows = last_.size() == count && seconds(scan.time - last_at_) < kNeighbourS && last_at_ < scan.time;
  if (covered_.size() != count) {
    covered_.assign(count, false);
    since_.reset();
  }
  std::vector<bool> lost(count, false);
  std::size_t lost_count = 0;
  std::size_t still = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_range = scan.beams[i].kind == BeamKind::kRange;
    lost[i] = follows && !has_range && last_[i] == BeamKind::kRange;
    lost_count += lost[i] ? 1 : 0;
    if (has_range) covered_[i] = false;
    still += covered_[i] ? 1 : 0;
  }
  if (static_cast<double>(lost_count) >= kCoveredShare * static_cast<double>(count)) {
    for (std::size_t i = 0; i < count; ++i) covered_[i] = covered_[i] || lost[i];
    if (!since_) since_ = scan.time;
  } else if (since_ && static_cast<double>(still) < kUncoveredShare * static_cast<double>(count)) {
    covered_.assign(count, false);
    since_.reset();
  }
  last_.resize(count);
  std::transform(scan.beams.begin(), scan.beams.end(), last_.begin(), [](const Beam& beam) { return beam.kind; });
  last_at_ = scan.time;
}

Scan CoveredSector::without(Scan scan) const {
  if (!since_ || covered_.size() != scan.beams.size()) return scan;
  for (std::size_t i = 0; i < covered_.size(); ++i) {
    if (covered_[i]) scan.beams[i].kind = BeamKind::kNotValid;
  }
  return scan;
}

// --- what the scans say ---

void LaserWatch::observe(const Scan& scan) {
  newest_ = scan.time;
  sector_.observe(scan);
  watch_emptiness(scan);
  const auto odom_from_robot = wheels_.odom_from_robot(scan.time);
  watch_repetition(scan, odom_from_robot);
  watch_motion(scan, odom_from_robot);
}

void LaserWatch::watch_emptiness(const Scan& scan) {
  if (!brings_nothing(scan)) {
    empty_since_.reset();
  } else if (!empty_since_) {
    empty_since_ = scan.time;
  }
}

bool LaserWatch::sees_nothing() const {
  if (const auto since = sector_.since(); since && seconds(newest_ - *since) >= kBlindS) return true;
  const bool is_excused = excused_at_ && seconds(newest_ - *excused_at_) < kExcuseLifeS;
  return empty_since_ && !is_excused && seconds(newest_ - *empty_since_) >= kBlindS;
}

void LaserWatch::watch_repetition(const Scan& scan, const std::optional<Pose2>& odom_from_robot) {
  const bool goes_on = first_alike_ && first_alike_->epoch == wheels_.epoch() && are_alike(first_alike_->scan, scan);
  if (!goes_on) {
    repeats_ = false;
    first_alike_.reset();
    if (odom_from_robot && ranges_in(scan) >= kFewestAlike)
      first_alike_ = Seen{scan, *odom_from_robot, wheels_.epoch()};
    return;
  }
  if (!odom_from_robot) return;
  repeats_ = repeats_ || is_a_way(motion_between(first_alike_->odom_from_robot, *odom_from_robot), kAlikeM, kAlikeRad);
}

void LaserWatch::watch_motion(const Scan& scan, const std::optional<Pose2>& odom_from_robot) {
  if (!odom_from_robot) return reference_.reset();
  const auto begin_anew = [&] { reference_ = Seen{scan, *odom_from_robot, wheels_.epoch()}; };
  const bool is_usable = reference_ && reference_->epoch == wheels_.epoch() &&
                         reference_->scan.robot_from_laser == scan.robot_from_laser &&
                         seconds(scan.time - reference_->scan.time) < kWayMostS;
  if (!is_usable) return begin_anew();
  const Pose2 motion = motion_between(reference_->odom_from_robot, *odom_from_robot);
  if (repeats_) return begin_anew();  // a scan that is not new tells nothing of the wheels
  if (!is_a_way(motion, kWayM, kWayRad)) return;
  const ShownMotion shown = shown_motion(reference_->scan, scan, motion);
  begin_anew();
  if (shown.asked < kFewestAsked) return;
  const double more = shown.otherwise - shown.as_told;
  const bool shows_otherwise = shown.otherwise >= kShownAtLeast && more >= kMoreThanTold;
  const bool shows_neither = shown.asked >= kClearAsked && shown.as_told < kLittleAsTold;
  const bool is_clear = shown.asked >= kClearAsked && more >= kClearlyMore;
  if (!shows_otherwise && !shows_neither)
    contradictions_ = 0;
  else
    contradictions_ += is_clear ? kContradictions : 1;
}

bool LaserWatch::contradicts_wheels() const { return contradictions_ >= kContradictions; }

}  // namespace deltamap::navigation
