// SPDX-License-Identifier: Apache-2.0
// Reads a CARMEN log line by line, in constant memory: its scans and poses in one run of times. Lines of other kinds
// are skipped, broken ones left out and counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/carmen/carmen_line.hpp"
#include "drivers/carmen/carmen_timeline.hpp"

namespace deltamap::drivers::carmen {

/// Where a log's PARAM lines have its laser on the robot.
struct StatedMount {
  std::optional<double> x_m;      ///< robot_frontlaser_offset
  std::optional<double> y_m;      ///< robot_frontlaser_side_offset
  std::optional<double> yaw_rad;  ///< robot_frontlaser_angular_offset

  [[nodiscard]] bool is_given() const { return x_m || y_m || yaw_rad; }
};

/// What of a log's lines was left out or changed.
struct CarmenFaults {
  std::size_t broken_lines = 0;
  std::vector<std::string> broken;                         ///< the first of them: "FILE:LINE: why"
  std::map<std::string, std::size_t, std::less<>> others;  ///< lines of other lasers by kind
  StatedMount stated_mount;
  std::vector<std::string> clock;    ///< steps of the log's clock, one line each
  std::vector<std::string> repeats;  ///< scans that repeat a stamp, one line each
};

class CarmenLog {
 public:
  /// Throws std::runtime_error naming the file where it is missing, empty, compressed, a CARMEN map or a folder.
  explicit CarmenLog(std::filesystem::path file, const CarmenClock& clock = {},
                     HeadingUnit headings = HeadingUnit::kRadian);

  /// The next scan or pose; nothing at the end. Throws std::runtime_error "FILE:LINE: why" at the end of a file that
  /// held no record at all.
  [[nodiscard]] std::optional<CarmenRecord> next();

  /// Where the log was cut: one line "FILE:LINE: why…" once the end was met, where no record follows a broken line.
  [[nodiscard]] const std::optional<std::string>& cut() const { return cut_; }
  /// Of the lines read so far; a line where the log was cut is none of them.
  [[nodiscard]] CarmenFaults faults() const;

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
  [[nodiscard]] std::uint64_t read_bytes() const { return read_bytes_; }

 private:
  /// False at the end of the file.
  [[nodiscard]] bool read_line();
  /// Nothing where the line is of another kind. Throws std::runtime_error where it is broken.
  [[nodiscard]] std::optional<CarmenRecord> record_of_line();
  void keep_broken(const std::string& why);
  void look_at_other(std::string_view text);
  void look_at_parameter(std::string_view text);
  void end();

  std::filesystem::path file_;
  CarmenClock clock_;
  HeadingUnit headings_;
  std::ifstream in_;
  std::string text_;
  bool is_text_ = true;                                         // the line in text_
  bool is_ended_ = true;                                        // by a line feed
  std::map<std::string, std::size_t, std::less<>> time_words_;  // of the first line of each kind
  std::optional<std::string> cut_;
  CarmenTimeline timeline_;
  CarmenFaults faults_;
  std::vector<std::string> broken_since_record_;  // the first of the lines behind the last record
  std::size_t lines_since_record_ = 0;            // broken ones
  bool is_over_ = false;
  std::size_t line_ = 0;
  std::size_t records_ = 0;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t read_bytes_ = 0;
};

}  // namespace deltamap::drivers::carmen
