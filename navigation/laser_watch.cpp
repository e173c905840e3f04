// SPDX-License-Identifier: Apache-2.0
#include "navigation/laser_watch.hpp"

#include <algorithm>
#include <cmath>

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
constexpr double kCircleRad = radians(90.0);  // of ranges that are one and the same,
constexpr float kCircleM = 0.01F;             // to the centimetre

std::size_t ranges_in(const Scan& scan) {
  return static_cast<std::size_t>(std::count_if(scan.beams.begin(), scan.beams.end(),
                                                [](const Beam& beam) { return beam.kind == BeamKind::kRange; }));
}

bool are_alike(const Scan& one, const Scan& other) {
  return std::equal(one.beams.begin(), one.beams.end(), other.beams.begin(), other.beams.end(),
                    [](const Beam& a, const Beam& b) { return a.kind == b.kind && a.range_m == b.range_m; });
}

/// Over a part of the fan all ranges are the same.
bool is_circle(const Scan& scan) {
  if (scan.bearing_step_rad == 0.0) return false;
  const auto wanted = static_cast<std::size_t>(std::ceil(kCircleRad / std::abs(scan.bearing_step_rad) - 1e-6)) + 1;
  for (std::size_t first = 0; first + wanted <= scan.beams.size();) {
    float least = scan.beams[first].range_m;
    float most = least;
    std::size_t beam = first;
    for (; beam < first + wanted && scan.beams[beam].kind == BeamKind::kRange; ++beam) {
      least = std::min(least, scan.beams[beam].range_m);
      most = std::max(most, scan.beams[beam].range_m);
      if (most - least > kCircleM) break;
    }
    if (beam == first + wanted) return true;
    first += beam > first && scan.beams[beam].kind == BeamKind::kRange ? 1 : beam - first + 1;
  }
  return false;
}

}  // namespace

bool brings_nothing(const Scan& scan) {
  return static_cast<double>(ranges_in(scan)) < std::max(1.0, kFewShare * static_cast<double>(scan.beams.size()));
}

bool is_implausible(const Scan& scan) { return scan.implausible || is_circle(scan); }

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
    broke_off_at_ = scan.time;
  } else if (since_ && static_cast<double>(still) < kUncoveredShare * static_cast<double>(count)) {
    covered_.assign(count, false);
    since_.reset();
  }
  last_.resize(count);
  std::transform(scan.beams.begin(), scan.beams.end(), last_.begin(), [](const Beam& beam) { return beam.kind; });
  last_at_ = scan.time;
}

void CoveredSector::forget() {
  covered_.assign(covered_.size(), false);
  since_.reset();
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
  const auto odom_from_robot = wheels_.odom_from_robot(scan.time);
  watch_repetition(scan, odom_from_robot);
  const bool is_believable = !repeats_ && !is_implausible(scan);
  if (!is_believable)
    sector_.skip();
  else
    sector_.observe(scan);
  watch_emptiness(scan);
  if (odom_from_robot && is_believable)
    (void)motion_.observe(scan, *odom_from_robot, wheels_.epoch());
  else
    motion_.skip();
}

void LaserWatch::watch_emptiness(const Scan& scan) {
  if (!brings_nothing(scan)) {
    empty_since_.reset();
  } else if (!empty_since_) {
    empty_since_ = scan.time;
  }
}

bool LaserWatch::sees_nothing() const {
  const auto lasts = [&](const std::optional<Timestamp>& since) {
    return since && seconds(newest_ - *since) >= kBlindS;
  };
  return (lasts(sector_.since()) && !excuses_sector()) || (lasts(empty_since_) && !is_excused());
}

bool LaserWatch::is_excused() const { return excused_at_ && seconds(newest_ - *excused_at_) < kExcuseLifeS; }

/// Not where all ranges broke off: the world does not vanish so. Nor by what was said before they did.
bool LaserWatch::excuses_sector() const {
  return is_excused() && !empty_since_ && *excused_at_ >= sector_.broke_off_at();
}

Scan LaserWatch::proven(const Scan& scan) const {
  Scan proven = sector_.without(scan);
  if (!repeats_ && !is_implausible(scan)) return proven;
  for (Beam& beam : proven.beams) beam.kind = BeamKind::kNotValid;
  return proven;
}

void LaserWatch::begin_anew() {
  motion_.forget_contradiction();
  sector_.forget();
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
  const Pose2 motion = motion_between(first_alike_->odom_from_robot, *odom_from_robot);
  repeats_ = repeats_ || std::hypot(motion.x, motion.y) >= kAlikeM || std::abs(motion.theta) >= kAlikeRad;
}

}  // namespace deltamap::navigation
