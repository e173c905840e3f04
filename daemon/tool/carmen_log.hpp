// SPDX-License-Identifier: Apache-2.0
// Reads a CARMEN log line by line, in constant memory: FLASER, ROBOTLASER1 and RAWLASER1 scans and ODOM poses. Lines of
// other kinds are skipped. The formats are those of CARMEN's logger; a line's time is its first time stamp (of the
// measurement), not the second (of the logger).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/pose2.hpp"
#include "core/time.hpp"

namespace deltamap::daemon::tool {

/// The two poses that a scan line carries, both in the frame of the odometry (or of the map, in a corrected log).
struct CarmenPoses {
  Pose2 odom_from_laser;
  Pose2 odom_from_robot;
};

/// Value i points to first_bearing_rad + i · bearing_step_rad in the laser's frame.
struct CarmenScan {
  std::size_t line = 0;  ///< in the file, from 1
  Timestamp time;
  double first_bearing_rad = 0.0;
  double bearing_step_rad = 0.0;
  std::optional<double> stated_max_range_m;  ///< the log's own words; FLASER has none
  std::vector<double> ranges_m;              ///< as logged, no-return codes included; 0 where not a number or negative
  std::optional<CarmenPoses> poses;          ///< none in RAWLASER1
};

struct CarmenOdometry {
  std::size_t line = 0;
  Timestamp time;
  Pose2 odom_from_robot;
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
};

using CarmenRecord = std::variant<CarmenOdometry, CarmenScan>;

class CarmenLog {
 public:
  /// Throws std::runtime_error naming the file where it is missing, empty, compressed or a folder.
  explicit CarmenLog(std::filesystem::path file);

  /// The next scan or pose; nothing at the end. Throws std::runtime_error "FILE:LINE: why" at a line that is cut or
  /// broken, and at the end of a file that held no record at all.
  [[nodiscard]] std::optional<CarmenRecord> next();

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
  [[nodiscard]] std::uint64_t read_bytes() const { return read_bytes_; }

 private:
  [[nodiscard]] bool read_line();

  std::filesystem::path file_;
  std::ifstream in_;
  std::string text_;
  std::size_t line_ = 0;
  std::size_t records_ = 0;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t read_bytes_ = 0;
};

}  // namespace deltamap::daemon::tool
