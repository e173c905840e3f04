// SPDX-License-Identifier: Apache-2.0
// Whether the laser can be believed: what it has ceased to see, whether it repeats itself, and whether its scans follow
// the wheels. Looks at scans and odometry alone, so that no pose and no map is needed; a map may only excuse a laser
// that sees nothing, or nothing in a sector.
#pragma once

#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "navigation/motion_watch.hpp"
#include "navigation/wheel_path.hpp"

namespace deltamap::navigation {

/// So few ranges that there are none.
[[nodiscard]] bool brings_nothing(const Scan& scan);

/// The laser flags its values, or they are alike over a quarter turn: no room is a circle around its laser.
[[nodiscard]] bool is_implausible(const Scan& scan);

/// A sector in which ranges broke off all at once is taken for covered until ranges come from it again, or a person has
/// said drive.
class CoveredSector {
 public:
  void observe(const Scan& scan);
  /// This scan tells nothing: the next one is not held against it.
  void skip() { last_.clear(); }
  void forget();
  [[nodiscard]] bool is_there() const { return since_.has_value(); }
  [[nodiscard]] std::optional<Timestamp> since() const { return since_; }
  /// When ranges last broke off.
  [[nodiscard]] Timestamp broke_off_at() const { return broke_off_at_; }
  /// The scan with these beams as not valid: what they do not see is not free.
  [[nodiscard]] Scan without(Scan scan) const;

 private:
  std::vector<BeamKind> last_;  // of each beam
  Timestamp last_at_{};
  std::vector<bool> covered_;  // a beam each
  std::optional<Timestamp> since_;
  Timestamp broke_off_at_{};
};

class LaserWatch {
 public:
  void observe(const Odometry& odometry) { wheels_.observe(odometry); }
  void observe(const Scan& scan);
  /// Whoever knows map and pose: of the scan of that time the beams without a range had nothing within reach. Counts
  /// for a moment; nothing withdraws it.
  void excuse(std::optional<Timestamp> scan_time) { excused_at_ = scan_time; }
  [[nodiscard]] const WheelPath& wheels() const { return wheels_; }
  /// A person said drive: what contradicted the wheels, and a sector that lost its ranges, is held against it no more.
  void begin_anew();

  /// No range for a second, or none from a sector that had some.
  [[nodiscard]] bool sees_nothing() const;
  /// The same ranges again and again, to the last digit, while the wheels turn.
  [[nodiscard]] bool repeats_itself() const { return repeats_; }
  /// Whether the scans follow the wheels, and have shown that the laser looks where its mount says.
  [[nodiscard]] const MotionWatch& motion() const { return motion_; }
  /// The scan, and what it leaves open: beams of a covered sector as not valid.
  [[nodiscard]] Scan believed(const Scan& scan) const { return excuses_sector() ? scan : sector_.without(scan); }
  /// What of it tells that a place is free: nothing that is implausible, or repeated, and no beam of a sector that
  /// broke off, excused or not.
  [[nodiscard]] Scan proven(const Scan& scan) const;

 private:
  struct Seen {
    Scan scan;
    Pose2 odom_from_robot;
    std::uint32_t epoch;
  };
  [[nodiscard]] bool is_excused() const;
  [[nodiscard]] bool excuses_sector() const;
  void watch_emptiness(const Scan& scan);
  void watch_repetition(const Scan& scan, const std::optional<Pose2>& odom_from_robot);

  WheelPath wheels_;
  CoveredSector sector_;
  Timestamp newest_{};
  std::optional<Timestamp> empty_since_;
  std::optional<Timestamp> excused_at_;
  std::optional<Seen> first_alike_;  // of the scans that are the same
  bool repeats_ = false;
  MotionWatch motion_;
};

}  // namespace deltamap::navigation
