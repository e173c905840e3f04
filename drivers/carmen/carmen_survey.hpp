// SPDX-License-Identifier: Apache-2.0
// The first look at a CARMEN log, before it is turned into bytes: which unit its words need, which value means "no
// return", where its poses come from, which variant of the LMS200 its scans are like (docs/protocols/README.md,
// CARMEN logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"
#include "drivers/carmen/carmen_log.hpp"
#include "drivers/carmen/carmen_resets.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/variant.hpp"

namespace deltamap::drivers::carmen {

struct TimedPose {
  Timestamp time;
  Pose2 odom_from_robot;  ///< without the log's resets
};

struct CarmenSurvey {
  std::size_t scans = 0;          ///< that will be imported
  std::size_t doubled_scans = 0;  ///< without a pose in a log whose other scans have one: the same sweeps once more
  bool scans_carry_poses = false;
  std::vector<TimedPose> odometry;  ///< by time; empty where the scans carry poses
  CarmenClock clock;
  HeadingUnit headings = HeadingUnit::kRadian;
  std::string no_clock;                   ///< why no time of the log can be used; empty where one can
  std::optional<std::string> cut;         ///< where the log was cut: one line
  std::vector<OdometryReset> resets;      ///< of the poses that are imported
  std::optional<Pose2> robot_from_laser;  ///< the mount that the log's scan lines have
  std::vector<std::string> notes;         ///< what is left out, filled in or doubted, one line each
  std::vector<std::string> drive_notes;   ///< the same of times and odometry, for an import
  std::vector<std::string> map_notes;     ///< the same of times and laser poses, for a map that is drawn at these

  drivers::lms200::Units units = drivers::lms200::Units::kMillimetre;
  std::uint8_t measuring_mode = 0;                 ///< protocols.md B4: the one whose codes hold the longest word
  std::optional<double> no_return_m;               ///< this range and longer ones are no return
  double no_return_up_to_m = 0.0;                  ///< the log's largest value; 0 where no_return_m was given
  double no_return_share = 0.0;                    ///< of all beams; 0 where the value was given
  drivers::lms200::ScanVariant variant{180, 100};  ///< of the first scan
};

/// The LMS200 variant that is nearest to a scan: first by its field of view, then by its step.
[[nodiscard]] drivers::lms200::ScanVariant nearest_variant(const CarmenScan& scan);

/// Reads the whole log. `no_return_m` stands in for the log's largest values. Throws std::runtime_error as CarmenLog
/// does, and where there is no scan. `tell_bytes` is told how far it is, and of how much.
[[nodiscard]] CarmenSurvey survey_of(
    const std::filesystem::path& log, std::optional<double> no_return_m,
    const std::function<void(std::uint64_t read, std::uint64_t total)>& tell_bytes = {});

/// What is printed of scans without a pose that are left out.
[[nodiscard]] std::string doubled_line(const CarmenSurvey& survey);
/// What is printed about it; "" where no value of the log is taken for no return.
[[nodiscard]] std::string no_return_line(const CarmenSurvey& survey);

/// What `--no-return` means, for every command that reads a log.
inline constexpr const char* kNoReturnHelp =
    "ranges of this many metres and more are no return (0: only the scanner's own codes are); default: the values "
    "within 0.15 m of the log's largest, where at least 0.3 % of the beams have them and they stand apart from all "
    "others";

}  // namespace deltamap::drivers::carmen
