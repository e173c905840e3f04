// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "core/counted.hpp"
#include "core/geometry/angle.hpp"
#include "drivers/carmen/carmen_doubts.hpp"
#include "drivers/carmen/carmen_headings.hpp"
#include "drivers/carmen/carmen_words.hpp"

namespace deltamap::drivers::carmen {
namespace {

using drivers::lms200::ScanVariant;
using drivers::lms200::Units;

constexpr double kNoReturnShare = 0.003;     // of the beams, before the largest values count as no return
constexpr double kNoReturnWidthM = 0.15;     // so far below the largest one; a cluster of codes is 0.11 m wide
constexpr double kNoReturnGapM = 0.3;        // below the values that are no return: what goes over into ranges is one
constexpr double kDecimalTolerance = 1e-9;   // m
constexpr double kMultipleTolerance = 1e-6;  // of a centimetre: what parsing decimals may cost
constexpr std::int64_t kLongestWord = 0x7FFF;

std::int64_t word_of(double range_m, double words_per_m) { return std::llround(std::min(range_m * words_per_m, 1e9)); }

/// Gathers what the simulated laser's words depend on, from all ranges of the log: in centimetres and in millimetres,
/// until it is clear which unit the log has.
class RangeCensus {
 public:
  void add(double range_m) {
    ++beams_;
    const double range_cm = range_m * 100.0;
    all_are_centimetres_ = all_are_centimetres_ && std::abs(range_cm - std::round(range_cm)) < kMultipleTolerance;
    if (range_m > 0.0 && (largest_.empty() || range_m >= lowest_of(largest_.rbegin()->first) - kNoReturnGapM)) {
      ++largest_[range_m];
      largest_.erase(largest_.begin(), largest_.lower_bound(lowest_of(largest_.rbegin()->first) - kNoReturnGapM));
    }
    note_word(longest_cm_, word_of(range_m, 100.0));
    note_word(longest_mm_, word_of(range_m, 1000.0));
  }

  [[nodiscard]] Units units() const { return all_are_centimetres_ ? Units::kCentimetre : Units::kMillimetre; }
  /// The mode with the fewest bits of range that holds the longest word, its codes included (B4: 00, 04, 06).
  [[nodiscard]] std::uint8_t measuring_mode() const {
    const std::int64_t longest = units() == Units::kCentimetre ? longest_cm_ : longest_mm_;
    return longest <= 0x1FFF ? 0x00 : longest <= 0x3FFF ? 0x04 : 0x06;
  }
  /// Finds the value that stands for "no return": the lowest of the values near the largest one, where those are many.
  /// Where the largest is a code of the scanner, only codes count, because true ranges may lie close to them. Otherwise
  /// it must be one and the same value, or stand apart from all smaller ones: the corners of a room do neither.
  void find_no_return(CarmenSurvey& survey) const {
    const double words_per_m = units() == Units::kCentimetre ? 100.0 : 1000.0;
    const auto is_code = [&](double range_m) { return is_scanner_code(word_of(range_m, words_per_m)); };
    const bool codes_alone = !largest_.empty() && is_code(largest_.rbegin()->first);
    std::size_t count = 0;
    std::optional<double> lowest_m;
    std::size_t values = 0;
    std::optional<double> below_m;  // the largest of the other values, where it is near
    for (const auto& [range_m, beams] : largest_) {
      if (range_m < lowest_of(largest_.rbegin()->first)) below_m = range_m;
      if (range_m < lowest_of(largest_.rbegin()->first) || (codes_alone && !is_code(range_m))) continue;
      if (!lowest_m) lowest_m = range_m;
      count += beams;
      ++values;
    }
    const bool stands_apart = !below_m || !lowest_m || *lowest_m - *below_m > kNoReturnGapM;
    if (!codes_alone && values != 1 && !stands_apart) return;
    const double share = static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, beams_));
    if (!lowest_m || share < kNoReturnShare) return;
    survey.no_return_m = lowest_m;
    survey.no_return_up_to_m = largest_.rbegin()->first;
    survey.no_return_share = share;
  }

 private:
  static double lowest_of(double largest_m) { return largest_m - kNoReturnWidthM - kDecimalTolerance; }
  static void note_word(std::int64_t& longest, std::int64_t word) {
    if (word <= kLongestWord) longest = std::max(longest, word);  // longer ones become "beyond maximum" in any mode
  }

  std::size_t beams_ = 0;
  bool all_are_centimetres_ = true;
  std::map<double, std::size_t> largest_;  // beams by range, for the ranges near the largest one
  std::int64_t longest_cm_ = 0;
  std::int64_t longest_mm_ = 0;
};

/// What the survey gathers on its way through the log.
struct Gathered {
  RangeCensus census{};
  CarmenDoubts doubts{};
  std::vector<LoggedPose> poses{};
  std::vector<LoggedPose> laser_poses{};
};

void add_scan(CarmenSurvey& survey, Gathered& gathered, const CarmenScan& scan) {
  if (scan.poses && !survey.scans_carry_poses) {  // what came before without a pose is left out
    survey.scans_carry_poses = true;
    survey.doubled_scans = survey.scans;
    survey.scans = 0;
    gathered.poses.clear();
    gathered.doubts = {};
  }
  if (survey.scans_carry_poses && !scan.poses) {
    ++survey.doubled_scans;
    return;
  }
  if (scan.is_repeated && survey.no_clock.empty()) return;
  if (survey.scans == 0) survey.variant = nearest_variant(scan);
  ++survey.scans;
  gathered.doubts.add(scan);
  if (scan.poses) {
    gathered.poses.push_back({scan.line, scan.time, scan.poses->odom_from_robot});
    gathered.laser_poses.push_back({scan.line, scan.time, scan.poses->odom_from_laser});
  }
  for (const double range_m : scan.ranges_m) gathered.census.add(range_m);
}

/// Poses without the log's resets, by time where they are ODOM lines; and what is told of the whole log.
void conclude(CarmenSurvey& survey, const Gathered& gathered, const CarmenFaults& faults) {
  survey.robot_from_laser = gathered.doubts.robot_from_laser();
  for (std::string& line : gathered.doubts.lines(faults)) survey.notes.push_back(std::move(line));
  const auto jumps = resets_in(gathered.laser_poses);
  if (survey.no_clock.empty()) survey.map_notes = faults.clock;
  if (std::string line = laser_jumps_line(jumps); !line.empty()) survey.map_notes.push_back(std::move(line));
  if (!survey.no_clock.empty()) return;
  survey.drive_notes = faults.clock;
  survey.drive_notes.insert(survey.drive_notes.end(), faults.repeats.begin(), faults.repeats.end());
  survey.resets = resets_in(gathered.poses);
  if (std::string line = resets_line(survey.resets); !line.empty()) survey.drive_notes.push_back(std::move(line));
  if (survey.scans_carry_poses) return;
  for (const LoggedPose& pose : gathered.poses)
    survey.odometry.push_back({pose.time, without_resets(survey.resets, pose.line, pose.odom_from_robot)});
  std::stable_sort(survey.odometry.begin(), survey.odometry.end(),
                   [](const TimedPose& a, const TimedPose& b) { return a.time < b.time; });
}

/// How well each of the two times tells the scans of a log apart.
class ClockCensus {
 public:
  void add(const CarmenTimes& times, bool is_scan) {
    if (!first_) first_ = times;
    has_stamps_ = has_stamps_ && times.stamp;
    has_logger_ = has_logger_ && times.logger;
    if (!is_scan) return;
    ++scans_;
    same_stamp_ += scans_ > 1 && times.stamp == last_.stamp ? 1 : 0;
    same_logger_ += scans_ > 1 && times.logger == last_.logger ? 1 : 0;
    last_ = times;
  }
  void choose(CarmenSurvey& survey) const {
    const bool stamps_serve = has_stamps_ && 2 * same_stamp_ <= scans_;
    const bool logger_serves = has_logger_ && 2 * same_logger_ <= scans_;
    if (stamps_serve) return;
    if (!logger_serves) {
      survey.no_clock = has_stamps_ ? std::to_string(same_stamp_) + " of " + std::to_string(scans_) +
                                          " scans have the time stamp of the one before"
                                    : "its lines have no time stamp";
      return;
    }
    // The first line keeps its stamp, where it has one; the logger's clock counts on from there.
    survey.clock.by_logger = true;
    survey.clock.logger_began =
        first_->stamp ? *first_->stamp - *first_->logger : Timestamp{} + std::max(Duration{0}, -*first_->logger);
  }

 private:
  std::optional<CarmenTimes> first_;
  CarmenTimes last_;
  bool has_stamps_ = true;
  bool has_logger_ = true;
  std::size_t scans_ = 0;
  std::size_t same_stamp_ = 0;
  std::size_t same_logger_ = 0;
};

/// How the log is to be read: by which clock, and in which unit its headings are. Those that are imported count.
void find_dialect(CarmenSurvey& survey, const std::filesystem::path& log) {
  CarmenLog lines{log};
  ClockCensus clock;
  HeadingCensus of_robot;
  HeadingCensus of_laser;
  HeadingCensus of_odometry;
  bool scans_carry_poses = false;
  while (const auto record = lines.next()) {
    std::visit([&](const auto& held) { clock.add(held.times, std::is_same_v<decltype(held), const CarmenScan&>); },
               *record);
    if (const auto* odometry = std::get_if<CarmenOdometry>(&*record)) {
      of_odometry.add(odometry->line, odometry->odom_from_robot.position(), odometry->heading);
    } else if (const auto& scan = std::get<CarmenScan>(*record); scan.poses) {
      scans_carry_poses = true;
      of_robot.add(scan.line, scan.poses->odom_from_robot.position(), scan.poses->robot_heading);
      of_laser.add(scan.line, scan.poses->odom_from_laser.position(), scan.poses->laser_heading);
    }
  }
  clock.choose(survey);
  // Some logs have true poses for the laser alone.
  const bool robot_tells = of_robot.has_way() || of_robot.unit() == HeadingUnit::kDegree;
  const HeadingCensus& of_scans = robot_tells ? of_robot : of_laser;
  const HeadingCensus& headings = scans_carry_poses ? of_scans : of_odometry;
  survey.headings = headings.unit();
  if (std::string line = headings.line(); !line.empty()) survey.notes.push_back(std::move(line));
}

}  // namespace

ScanVariant nearest_variant(const CarmenScan& scan) {
  const double step_deg = degrees(scan.bearing_step_rad);
  const double field_deg = step_deg * static_cast<double>(scan.ranges_m.size() - 1);
  const std::uint16_t angle_deg = std::abs(field_deg - 180.0) <= std::abs(field_deg - 100.0) ? 180 : 100;
  const auto distance = [&](const ScanVariant& v) { return std::abs(v.resolution_centideg * 0.01 - step_deg); };
  ScanVariant nearest{angle_deg, 100};
  for (const std::uint16_t centideg : {std::uint16_t{50}, std::uint16_t{25}}) {
    const ScanVariant variant{angle_deg, centideg};
    if (is_possible(variant) && distance(variant) < distance(nearest)) nearest = variant;
  }
  return nearest;
}

CarmenSurvey survey_of(const std::filesystem::path& log, std::optional<double> no_return_m,
                       const std::function<void(std::uint64_t read, std::uint64_t total)>& tell_bytes) {
  CarmenSurvey survey;
  find_dialect(survey, log);
  CarmenLog lines{log, survey.clock, survey.headings};
  Gathered gathered;
  while (const auto record = lines.next()) {
    if (tell_bytes) tell_bytes(lines.read_bytes(), lines.size_bytes());
    if (const auto* scan = std::get_if<CarmenScan>(&*record)) {
      add_scan(survey, gathered, *scan);
    } else if (!survey.scans_carry_poses) {
      const auto& odometry = std::get<CarmenOdometry>(*record);
      gathered.poses.push_back({odometry.line, odometry.time, odometry.odom_from_robot});
    }
  }
  survey.cut = lines.cut();
  if (survey.scans == 0) throw std::runtime_error(log.string() + ": no scan from the first line to the last");
  conclude(survey, gathered, lines.faults());
  const RangeCensus& census = gathered.census;
  survey.units = census.units();
  survey.measuring_mode = census.measuring_mode();
  if (no_return_m) {
    if (*no_return_m > 0.0) survey.no_return_m = no_return_m;
  } else {
    census.find_no_return(survey);
  }
  return survey;
}

std::string doubled_line(const CarmenSurvey& survey) {
  return counted(survey.doubled_scans, "scan") + " without a pose left out: the log's other scans carry poses";
}

std::string no_return_line(const CarmenSurvey& survey) {
  if (!survey.no_return_m) return "";
  std::ostringstream line;
  line << "no return: ";
  if (survey.no_return_share == 0.0) {
    line << *survey.no_return_m << " m and more, as given";
  } else {
    line << "the log's largest value" << (*survey.no_return_m < survey.no_return_up_to_m ? "s " : " ");
    if (*survey.no_return_m < survey.no_return_up_to_m) line << *survey.no_return_m << " to ";
    line << survey.no_return_up_to_m << " m, " << 100.0 * survey.no_return_share
         << " % of the beams (--no-return R overrides)";
  }
  return line.str();
}

}  // namespace deltamap::drivers::carmen
