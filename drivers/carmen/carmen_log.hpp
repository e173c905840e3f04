// SPDX-License-Identifier: Apache-2.0
// Reads a CARMEN log line by line, in constant memory: FLASER, ROBOTLASER1 and RAWLASER1 scans and ODOM poses. Lines of
// other kinds are skipped. The formats are those of CARMEN's logger; a line ends with the time stamp of the
// measurement, a host and the logger's own time, where it has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
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

/// The two poses that a scan line carries, both in the frame of the odometry (or of the map, in a corrected log).
struct CarmenPoses {
  Pose2 odom_from_laser;
  Pose2 odom_from_robot;
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
  std::optional<CarmenPoses> poses;          ///< none in RAWLASER1
};

struct CarmenOdometry {
  std::size_t line = 0;
  CarmenTimes times;
  Timestamp time;  ///< by the clock of the log
  Pose2 odom_from_robot;
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
};

using CarmenRecord = std::variant<CarmenOdometry, CarmenScan>;

class CarmenLog {
 public:
  /// Throws std::runtime_error naming the file where it is missing, empty, compressed, a CARMEN map or a folder.
  explicit CarmenLog(std::filesystem::path file, const CarmenClock& clock = {});

  /// The next scan or pose; nothing at the end, or at a broken line after which nothing can be read (ask cut()). Throws
  /// std::runtime_error "FILE:LINE: why" at any other broken line, and at the end of a file that held no record at all.
  [[nodiscard]] std::optional<CarmenRecord> next();

  /// Where the log was cut: one line "FILE:LINE: why…". Nothing while no cut has been met.
  [[nodiscard]] const std::optional<std::string>& cut() const { return cut_; }

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
  [[nodiscard]] std::uint64_t read_bytes() const { return read_bytes_; }

 private:
  /// False at the end of the file.
  [[nodiscard]] bool read_line();
  /// Nothing where the line is of another kind. Throws std::runtime_error where it is broken.
  [[nodiscard]] std::optional<CarmenRecord> record_of_line();
  [[nodiscard]] bool record_follows();

  std::filesystem::path file_;
  CarmenClock clock_;
  std::ifstream in_;
  std::string text_;
  bool is_text_ = true;                                         // the line in text_
  bool is_ended_ = true;                                        // by a line feed
  std::map<std::string, std::size_t, std::less<>> time_words_;  // of the first line of each kind
  std::optional<std::string> cut_;
  std::size_t line_ = 0;
  std::size_t records_ = 0;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t read_bytes_ = 0;
};

}  // namespace deltamap::drivers::carmen
