// SPDX-License-Identifier: Apache-2.0
// One line of a CARMEN log as what it says: FLASER, ROBOTLASER1 and RAWLASER1 scans and ODOM poses. The formats are
// those of CARMEN's logger; a line ends with the time stamp of the measurement, a host and the logger's own time, where
// it has them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"

namespace deltamap::drivers::carmen {

/// What a line says of its time; both are missing in some logs.
struct CarmenTimes {
  std::optional<Timestamp> stamp;  ///< of the measurement (IPC)
  std::optional<Duration> logger;  ///< since the logger's start; may be negative
  std::size_t words = 0;           ///< of the line: stamp, host, logger's time
};

/// Which of its times is a line's time. Stamps that were written with six digits are worth nothing.
struct CarmenClock {
  bool by_logger = false;
  Timestamp logger_began;  ///< time of a line = logger_began + its logger's time

  /// The beginning of 1970 where the line does not have that time.
  [[nodiscard]] Timestamp time_of(const CarmenTimes& times) const;
};

/// CARMEN has radians; some who write its logs have degrees.
enum class HeadingUnit { kRadian, kDegree };

/// The two poses that a scan line carries, both in the frame of the odometry (or of the map, in a corrected log).
struct CarmenPoses {
  Pose2 odom_from_laser;
  Pose2 odom_from_robot;
  double laser_heading = 0.0;  ///< as logged: neither wrapped nor in a known unit
  double robot_heading = 0.0;  ///< as logged
};

/// Value i points to first_bearing_rad + i · bearing_step_rad in the laser's frame.
struct CarmenScan {
  std::size_t line = 0;  ///< in the file, from 1
  CarmenTimes times;
  Timestamp time;  ///< by the clock of the log
  double first_bearing_rad = 0.0;
  double bearing_step_rad = 0.0;
  std::optional<double> stated_max_range_m;  ///< the log's own words; FLASER has none
  std::vector<double> ranges_m;              ///< as logged, no-return codes included; 0 where not a number or negative
  std::size_t not_numbers = 0;               ///< of these ranges
  bool has_guessed_field = false;            ///< the log does not say which way its values point, nor does their number
  bool is_repeated = false;                  ///< its time is not after that of the scan before
  std::optional<CarmenPoses> poses;          ///< none in RAWLASER1
};

struct CarmenOdometry {
  std::size_t line = 0;
  CarmenTimes times;
  Timestamp time;  ///< by the clock of the log
  Pose2 odom_from_robot;
  double heading = 0.0;  ///< as logged: neither wrapped nor in a known unit
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
};

using CarmenRecord = std::variant<CarmenOdometry, CarmenScan>;

/// The first word of a line.
[[nodiscard]] std::string_view kind_of(std::string_view line);

/// Nothing where the line is of another kind. Throws std::runtime_error "PLACE: why" where it is broken: words that are
/// no numbers, counts that do not fit, headings that are none, an end that is missing. `headings`: what the line has.
[[nodiscard]] std::optional<CarmenRecord> record_in(std::string_view line, const std::string& place,
                                                    HeadingUnit headings = HeadingUnit::kRadian);

}  // namespace deltamap::drivers::carmen
