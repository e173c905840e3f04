// SPDX-License-Identifier: Apache-2.0
// What is wanted of an LMS200, and how long it is waited for.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/variant.hpp"

namespace deltamap::drivers::lms200 {

/// Counter-clockwise from one bearing of the laser to another, both included: 0 is ahead of it, seen from above.
struct BearingRange {
  double from_rad = 0.0;
  double to_rad = 0.0;
  friend bool operator==(const BearingRange&, const BearingRange&) = default;
};

struct Lms200Params {
  ScanVariant variant{180, 50};                  ///< wanted; variant_named("180/0.5")
  Units units = Units::kMillimetre;              ///< wanted
  std::optional<std::uint8_t> measuring_mode{};  ///< wanted, B4 byte 5; empty: keep, but 06h where it is too short
  unsigned baud = 38400;                         ///< wanted: 9600, 19200, 38400 or 500000
  double max_range_m = 0.0;                      ///< longer ranges become kBeyondMaximum; 0: as far as the mode goes
  Pose2 robot_from_laser{};                      ///< the mount
  bool is_upside_down = false;                   ///< mounted so
  std::vector<BearingRange> ignored{};           ///< where the laser sees the robot itself: such beams are not valid
  double power_on_wait_s = 65.0;                 ///< how long a silent laser may still be starting up (B8)
  double scan_timeout_s = 2.0;                   ///< silence while streaming that is told, and sought at other bauds
  double assume_after_s = 5.0;  ///< a recording without the laser's replies: the wanted mode counts after this
};

}  // namespace deltamap::drivers::lms200
