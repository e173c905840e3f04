// SPDX-License-Identifier: Apache-2.0
// What other programs read as lines of text: trajectories (TUM), tables (CSV), CARMEN logs.
#pragma once

#include <iosfwd>
#include <span>
#include <string>

#include "core/messages.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/outputs/outputs.hpp"

namespace deltamap::tool {

/// "t x y 0 0 0 qz qw", a line a pose, in order of time and each time once: what evo asks of a trajectory.
void write_tum(std::vector<daemon::TrajectoryPoint> points, std::ostream& out);

/// A line a scan that was localized.
void write_run_csv(std::span<const daemon::LocalizationRow> rows, std::ostream& out);

/// The names of the columns of scan_csv_line(), with a line end.
[[nodiscard]] std::string scan_csv_header();
/// Ranges in m with blanks between them, counter-clockwise: "inf" beyond the maximum, "nan" where there is none.
[[nodiscard]] std::string scan_csv_line(const Scan& scan, const Pose2& odom_from_robot);

/// A ROBOTLASER1 line: field of view and resolution stand in it. Of a beam beyond the maximum it says the maximum, of
/// others without a range 0.
[[nodiscard]] std::string carmen_scan_line(const Scan& scan, const Pose2& odom_from_robot, Timestamp began);
/// An ODOM line.
[[nodiscard]] std::string carmen_odometry_line(const Odometry& odometry, const Pose2& odom_from_robot, Timestamp began);

}  // namespace deltamap::tool
