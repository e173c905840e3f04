// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/counted.hpp"
#include "core/files/shortest_text.hpp"
#include "core/geometry/angle.hpp"
#include "drivers/carmen/carmen_survey.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr double kFarthestRange_m = 100.0;  // an LMS measures 81.91 m; 100 mm are nearer than any of its ranges
constexpr std::size_t kFewValues = 3;
constexpr double kSamePlace_m = 0.02;  // logs round their poses to a centimetre
constexpr double kSameHeading_rad = 0.03;
constexpr double kMostAgree = 0.9;  // of the scans: the others are of messages that crossed
constexpr double kSameStep = 0.01;  // of a step: logs round radians

std::string rounded(double value, double digits) { return shortest_text(std::round(value * digits) / digits + 0.0); }

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool is_same_place(const Pose2& one, const Pose2& other) {
  return distance_between(one, other) < kSamePlace_m &&
         std::abs(turn_between(one.theta, other.theta)) < kSameHeading_rad;
}

std::string words_of_mount(const Pose2& robot_from_laser) {
  const double x_m = std::round(robot_from_laser.x * 1e3) / 1e3 + 0.0;
  const double y_m = std::round(robot_from_laser.y * 1e3) / 1e3 + 0.0;
  const double turned_deg = std::round(degrees(wrapped_angle(robot_from_laser.theta)) * 10.0) / 10.0 + 0.0;
  const double yaw_deg = turned_deg <= -180.0 ? 180.0 : turned_deg;
  char text[96];
  (void)std::snprintf(text, sizeof text, "the log has the laser at %.3f, %.3f m, %.1f°", x_m, y_m, yaw_deg);
  return std::string(text) + ": set laser.mount (--set laser.mount.x_m=" + shortest_text(x_m) +
         " --set laser.mount.y_m=" + shortest_text(y_m) + " --set laser.mount.yaw_deg=" + shortest_text(yaw_deg) + ")";
}

/// The field of view of scanners that have so many values; nothing where none is known.
std::optional<int> usual_field_deg(std::size_t values) {
  constexpr std::array<std::size_t, 6> kOf270{271, 540, 541, 811, 1080, 1081};  // 1°, 0.5°, 0.333°, 0.25°
  if (std::find(kOf270.begin(), kOf270.end(), values) != kOf270.end()) return 270;
  if (values >= 681 && values <= 683) return 240;  // 360°/1024
  return std::nullopt;
}

}  // namespace

void CarmenDoubts::add_beams_of(const CarmenScan& scan) {
  const lms200::ScanVariant variant = nearest_variant(scan);
  const double step_deg = degrees(scan.bearing_step_rad);
  const auto same = std::find_if(beams_.begin(), beams_.end(), [&](const Beams& one) {
    return one.all == scan.ranges_m.size() && std::abs(one.step_deg - step_deg) < kSameStep * step_deg;
  });
  if (same != beams_.end()) {
    ++same->scans;
    return;
  }
  const double variant_step_deg = variant.resolution_centideg * 0.01;
  Beams beams{1, scan.ranges_m.size(), 0, 0, step_deg, variant_step_deg, variant.angle_deg * 0.5};
  const double first_deg = degrees(scan.first_bearing_rad);
  const double half_deg = beams.half_deg;
  for (std::size_t i = 0; i < beams.all; ++i) {
    const double bearing_deg = first_deg + static_cast<double>(i) * step_deg;
    beams.beyond += std::abs(bearing_deg) > half_deg + step_deg / 2.0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < variant.values(); ++i) {
    const double at = std::round((static_cast<double>(i) * variant_step_deg - half_deg - first_deg) / step_deg);
    beams.missing += at < 0.0 || at >= static_cast<double>(beams.all) ? 1 : 0;
  }
  beams_.push_back(beams);
}

void CarmenDoubts::add(const CarmenScan& scan) {
  add_beams_of(scan);
  not_numbers_ += scan.not_numbers;
  if (scan.has_guessed_field) ++guessed_fields_[scan.ranges_m.size()];
  add_ranges_of(scan);
  if (scan.poses)
    mounts_.push_back({scan.line, motion_between(scan.poses->odom_from_robot, scan.poses->odom_from_laser)});
}

/// One value in place of all is a code for no return, however large.
void CarmenDoubts::add_ranges_of(const CarmenScan& scan) {
  std::size_t ranges = 0;
  std::size_t far = 0;
  std::set<double> values;
  for (const double range_m : scan.ranges_m) {
    ranges += range_m > 0.0 ? 1 : 0;
    if (range_m <= kFarthestRange_m) continue;
    ++far;
    if (values.size() < kFewValues) values.insert(range_m);
  }
  ++scans_;
  if (2 * far <= ranges || values.size() < kFewValues) return;
  if (far_scans_++ == 0) first_far_line_ = scan.line;
}

std::string CarmenDoubts::far_line() const {
  const std::string question = " that the scanner can measure: are its ranges in mm? CARMEN has metres";
  if (far_scans_ == 0) return "";
  if (far_scans_ == scans_) return "no beam of the log has a range" + question;
  return counted(far_scans_, "scan") + " (the first in line " + std::to_string(first_far_line_) + ") " +
         (far_scans_ == 1 ? "has" : "have") + " hardly a range" + question;
}

std::optional<Pose2> CarmenDoubts::robot_from_laser() const {
  if (mounts_.empty()) return std::nullopt;
  const auto median = [&](auto&& value_of) {
    std::vector<double> values;
    values.reserve(mounts_.size());
    for (const Mount& one : mounts_) values.push_back(value_of(one.robot_from_laser));
    return median_of(std::move(values));
  };
  const Pose2& first = mounts_.front().robot_from_laser;
  const Pose2 mount{
      median([](const Pose2& one) { return one.x; }), median([](const Pose2& one) { return one.y; }),
      wrapped_angle(first.theta + median([&](const Pose2& one) { return turn_between(first.theta, one.theta); }))};
  const auto agreeing = std::count_if(mounts_.begin(), mounts_.end(),
                                      [&](const Mount& one) { return is_same_place(one.robot_from_laser, mount); });
  if (static_cast<double>(agreeing) < kMostAgree * static_cast<double>(mounts_.size())) return std::nullopt;
  return mount;
}

std::string CarmenDoubts::mount_line(const StatedMount& stated) const {
  const auto mount = robot_from_laser();
  const std::string no_place =
      mount || mounts_.empty() ? "" : "the log's laser and robot poses keep no place to each other (corrected poses?)";
  if (!mount && !stated.is_given()) return no_place.empty() ? "" : no_place + ": it does not tell the mount";
  const Pose2 told =
      mount.value_or(Pose2{stated.x_m.value_or(0.0), stated.y_m.value_or(0.0), stated.yaw_rad.value_or(0.0)});
  std::string line = words_of_mount(told);
  if (!mount) return line + (no_place.empty() ? "" : "; that is what its PARAM lines say, " + no_place);
  const auto is_elsewhere = [&](const Mount& one) { return !is_same_place(one.robot_from_laser, told); };
  const auto elsewhere = static_cast<std::size_t>(std::count_if(mounts_.begin(), mounts_.end(), is_elsewhere));
  if (elsewhere > 0) {
    const auto first = std::find_if(mounts_.begin(), mounts_.end(), is_elsewhere);
    line += "; elsewhere in " + counted(elsewhere, "scan") + " (the first in line " + std::to_string(first->line) + ")";
  }
  if (stated.x_m && std::abs(*stated.x_m - told.x) > kSamePlace_m)
    line += "; its robot_frontlaser_offset says " + rounded(*stated.x_m, 1e4) + " m";
  if (stated.y_m && std::abs(*stated.y_m - told.y) > kSamePlace_m)
    line += "; its robot_frontlaser_side_offset says " + rounded(*stated.y_m, 1e4) + " m";
  if (stated.yaw_rad && std::abs(turn_between(*stated.yaw_rad, told.theta)) > kSameHeading_rad)
    line += "; its robot_frontlaser_angular_offset says " + rounded(degrees(*stated.yaw_rad), 10.0) + "°";
  return line;
}

std::vector<std::string> CarmenDoubts::lines(const CarmenFaults& faults) const {
  std::vector<std::string> lines;
  const auto add = [&](std::string line) { lines.push_back(std::move(line)); };
  for (const Beams& one : beams_) {
    const std::string of_scans = beams_.size() > 1 ? " in " + counted(one.scans, "scan") : "";
    if (one.beyond > 0) {
      add(std::to_string(one.beyond) + " of " + std::to_string(one.all) +
          (one.beyond == 1 ? " beams a scan lies beyond ±" : " beams a scan lie beyond ±") +
          rounded(one.half_deg, 1.0) + (one.beyond == 1 ? "° and is left out" : "° and are left out") + of_scans);
    }
    if (one.missing > 0)
      add("the log has no beam for " + counted(one.missing, "bearing") + " a scan: not valid" + of_scans);
    if (std::abs(one.step_deg - one.variant_step_deg) > kSameStep * one.variant_step_deg)
      add("beams every " + rounded(one.step_deg, 1e3) + "°: each bearing, every " + rounded(one.variant_step_deg, 1e3) +
          "°, takes the nearest" + of_scans);
  }
  for (const auto& [values, scans] : guessed_fields_) {
    const auto usual_deg = usual_field_deg(values);
    const std::string usual = usual_deg ? ", and scanners with so many see " + std::to_string(*usual_deg) + "°" : "";
    add("FLASER lines do not say where their " + std::to_string(values) + " values point: 180° are assumed in " +
        counted(scans, "scan") + usual + "; ROBOTLASER1 lines state start angle and field of view");
  }
  for (const auto& [kind, count] : faults.others) {
    add(counted(count, "scan") + " of " + kind +
        " left out: one laser is read, that of FLASER, ROBOTLASER1 and RAWLASER1");
  }
  if (faults.broken_lines > 0) {
    std::string line = counted(faults.broken_lines, "broken line") + " left out";
    for (const std::string& why : faults.broken) line += "; " + why;
    add(line);
  }
  if (not_numbers_ > 0)
    add(counted(not_numbers_, "range is no number", "ranges are no numbers") + ", or below 0: not valid");
  if (std::string line = far_line(); !line.empty()) add(std::move(line));
  if (std::string line = mount_line(faults.stated_mount); !line.empty()) add(std::move(line));
  return lines;
}

}  // namespace deltamap::drivers::carmen
