// SPDX-License-Identifier: Apache-2.0
#include "daemon/tool/carmen_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/angle.hpp"
#include "daemon/tool/progress.hpp"

namespace deltamap::daemon::tool {
namespace {

using drivers::lms200::ScanVariant;
using drivers::lms200::Units;

constexpr double kNoReturnShare = 0.003;     // CONTRACT.md: of the beams, before the largest value counts as no return
constexpr double kMultipleTolerance = 1e-6;  // of a centimetre: what parsing decimals may cost
constexpr std::int64_t kLongestWord = 0x7FFF;

std::int64_t word_of(double range_m, double words_per_m) { return std::llround(std::min(range_m * words_per_m, 1e9)); }

/// What has to be known of all ranges; for both units, until it is clear which one it is.
class RangeCensus {
 public:
  void add(double range_m) {
    ++beams_;
    const double range_cm = range_m * 100.0;
    all_are_centimetres_ = all_are_centimetres_ && std::abs(range_cm - std::round(range_cm)) < kMultipleTolerance;
    if (range_m > largest_m_) {
      largest_m_ = range_m;
      largest_count_ = 0;
    }
    if (range_m == largest_m_) ++largest_count_;
    note_word(longest_cm_, word_of(range_m, 100.0));
    note_word(longest_mm_, word_of(range_m, 1000.0));
  }

  [[nodiscard]] Units units() const { return all_are_centimetres_ ? Units::kCentimetre : Units::kMillimetre; }
  /// The mode with the fewest bits of range that holds the longest word, its codes included (B4: 00, 04, 06).
  [[nodiscard]] std::uint8_t measuring_mode() const {
    const std::int64_t longest = units() == Units::kCentimetre ? longest_cm_ : longest_mm_;
    return longest <= 0x1FFF ? 0x00 : longest <= 0x3FFF ? 0x04 : 0x06;
  }
  [[nodiscard]] double largest_m() const { return largest_m_; }
  [[nodiscard]] double largest_share() const {
    return beams_ == 0 ? 0.0 : static_cast<double>(largest_count_) / static_cast<double>(beams_);
  }

 private:
  static void note_word(std::int64_t& longest, std::int64_t word) {
    if (word <= kLongestWord) longest = std::max(longest, word);  // longer ones become "beyond maximum" in any mode
  }

  std::size_t beams_ = 0;
  bool all_are_centimetres_ = true;
  double largest_m_ = 0.0;
  std::size_t largest_count_ = 0;
  std::int64_t longest_cm_ = 0;
  std::int64_t longest_mm_ = 0;
};

void add_scan(CarmenSurvey& survey, RangeCensus& census, const CarmenScan& scan) {
  if (scan.poses && !survey.scans_carry_poses) {  // what came before without a pose is left out
    survey.scans_carry_poses = true;
    survey.doubled_scans = survey.scans;
    survey.scans = 0;
    survey.odometry = {};
  }
  if (survey.scans_carry_poses && !scan.poses) {
    ++survey.doubled_scans;
    return;
  }
  if (survey.scans == 0) survey.variant = nearest_variant(scan);
  ++survey.scans;
  for (const double range_m : scan.ranges_m) census.add(range_m);
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

CarmenSurvey survey_of(const std::filesystem::path& log, std::optional<double> no_return_m) {
  CarmenLog lines{log};
  Progress progress{"looking through " + log.filename().string(), lines.size_bytes()};
  CarmenSurvey survey;
  RangeCensus census;
  while (const auto record = lines.next()) {
    progress.show(lines.read_bytes());
    if (const auto* scan = std::get_if<CarmenScan>(&*record)) {
      add_scan(survey, census, *scan);
    } else if (!survey.scans_carry_poses) {
      const auto& odometry = std::get<CarmenOdometry>(*record);
      survey.odometry.push_back({odometry.time, odometry.odom_from_robot});
    }
  }
  if (survey.scans == 0) throw std::runtime_error(log.string() + ": no scan from the first line to the last");
  std::stable_sort(survey.odometry.begin(), survey.odometry.end(),
                   [](const TimedPose& a, const TimedPose& b) { return a.time < b.time; });
  survey.units = census.units();
  survey.measuring_mode = census.measuring_mode();
  if (no_return_m) {
    if (*no_return_m > 0.0) survey.no_return_m = no_return_m;
  } else if (census.largest_share() >= kNoReturnShare) {
    survey.no_return_m = census.largest_m();
    survey.no_return_share = census.largest_share();
  }
  return survey;
}

}  // namespace deltamap::daemon::tool
