// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/counted.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr int kMaxReadings = 65536;
constexpr std::size_t kPoseWords = 6;                // of the laser and of the robot
constexpr std::size_t kMotionWords = 5;              // of ROBOTLASER1: speeds, safety distances, turn axis
constexpr std::size_t kTimesWords = 3;               // stamp, host, logger's time
constexpr double kMostHeading_rad = 1000.0;          // 160 turns: one that is not wrapped; a time stamp is more
constexpr double kFarthest_m = 1e8;                  // UTM coordinates are less, time stamps more
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // the year 2255: a Timestamp ends soon after

/// Takes the words of a line one by one; says what was expected where one is missing or broken.
class Words {
 public:
  Words(std::string_view text, std::string place, HeadingUnit headings)
      : text_{text}, place_{std::move(place)}, headings_{headings} {}

  [[noreturn]] void refuse(const std::string& why) const { throw std::runtime_error(place_ + ": " + why); }

  std::string_view word(const char* name) {
    const std::size_t start = text_.find_first_not_of(" \t\r");
    if (start == std::string_view::npos) refuse(std::string("cut short: '") + name + "' is missing");
    text_.remove_prefix(start);
    const std::string_view found = text_.substr(0, text_.find_first_of(" \t\r"));
    text_.remove_prefix(found.size());
    return found;
  }

  double number(const char* name) {
    const std::string_view found = word(name);
    double value = 0.0;
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc{} || end != found.data() + found.size()) refuse_word(name, found, "a number");
    return value;
  }

  double finite(const char* name) {
    const double value = number(name);
    if (!std::isfinite(value)) refuse(std::string("'") + name + "' is not finite");
    return value;
  }

  int count(const char* name) {
    const std::string_view found = word(name);
    const auto value = count_in(found);
    if (!value) refuse_word(name, found, "a count");
    return static_cast<int>(*value);
  }

  struct Posed {
    Pose2 pose;
    double heading = 0.0;  // as it stands there
  };
  Posed pose(const char* name) {
    const double x = finite(name);
    const double y = finite(name);
    const double heading = finite(name);
    const double heading_rad = headings_ == HeadingUnit::kDegree ? radians(heading) : heading;
    if (std::abs(heading_rad) > kMostHeading_rad) refuse_number(name, "heading", heading_rad, "rad");
    if (std::max(std::abs(x), std::abs(y)) > kFarthest_m)
      refuse_number(name, "place", std::max(std::abs(x), std::abs(y)), "m");
    return {{x, y, wrapped_angle(heading_rad)}, heading};
  }

  /// Holds the number of ranges that is told against the length of the line. `others` are the words between the ranges
  /// and the time stamp.
  void require_count(int count, std::size_t others) const {
    const std::vector<std::string_view> words = ended_words(others);
    if (words.empty()) return;
    const auto announced = static_cast<std::size_t>(count);
    const std::size_t there = words.size() - others - kTimesWords;
    // Without a stamp the word before the host is a heading.
    if (there != announced && (there + 1 != announced || is_stamp_before_host(words, kMostHeading_rad)))
      refuse_count(announced, "range", there);
  }

  /// As require_count(), where the number of remissions and these stand behind the ranges.
  void require_counts(int count, std::size_t others) const {
    const std::vector<std::string_view> words = ended_words(others);
    if (words.empty()) return;
    const auto announced = static_cast<std::size_t>(count);
    const auto fits = [&](std::size_t ranges, std::size_t times = kTimesWords) {
      const auto remissions = ranges < words.size() ? count_in(words[ranges]) : std::nullopt;
      return remissions && ranges + 1 + *remissions + others + times == words.size();
    };
    if (fits(announced)) return;
    const bool has_no_stamp = !is_stamp_before_host(words, kFarthest_m) && !fits(announced - 1);
    if (has_no_stamp && fits(announced, kTimesWords - 1)) return;
    const auto remissions = announced < words.size() ? count_in(words[announced]) : std::nullopt;
    const bool has_remissions = remissions && announced + 1 + others + kTimesWords <= words.size();
    const std::size_t left = has_remissions ? words.size() - announced - 1 - others - kTimesWords : 0;
    if (has_remissions && *remissions == announced) refuse_count(*remissions, "remission", left);
    for (std::size_t off = 1; off < words.size(); ++off) {
      if (off <= announced && fits(announced - off)) refuse_count(announced, "range", announced - off);
      if (fits(announced + off)) refuse_count(announced, "range", announced + off);
    }
    if (has_remissions) refuse_count(*remissions, "remission", left);
    refuse(counted(announced, "range") + " announced: no number of remissions stands behind them");
  }

  /// No record has more words than its times.
  void require_end() const {
    if (!at_end()) refuse("more words than the line's counts tell: do they fit?");
  }

  [[nodiscard]] bool at_end() const { return text_.find_first_not_of(" \t\r") == std::string_view::npos; }

  /// The words after a record's own: stamp, host, logger's time. Some logs have no stamp, or nothing at all.
  CarmenTimes times() {
    CarmenTimes times;
    for (Words left = *this; !left.at_end() && times.words < kTimesWords; ++times.words) (void)left.word("time");
    if (times.words == 0) return times;
    Words ahead = *this;
    const bool has_stamp = number_in(ahead.word("time stamp")).has_value();
    if (has_stamp || ahead.at_end()) times.stamp = time("time stamp");
    if (has_stamp && !at_end()) (void)word("host");
    if (!has_stamp) *this = ahead;  // the first word was the host
    const auto logger_s = at_end() ? std::nullopt : number_in(word("logger time"));
    if (logger_s && std::abs(*logger_s) < static_cast<double>(kMaxSeconds)) {
      times.logger = duration_from_seconds(*logger_s);
    }
    return times;
  }

 private:
  /// What is left of a line that the logger has ended, a host before the last word: what it counts can be held against
  /// its length. Else nothing.
  [[nodiscard]] std::vector<std::string_view> ended_words(std::size_t others) const {
    std::vector<std::string_view> words;
    for (Words left = *this; !left.at_end();) words.push_back(left.word("word"));
    if (words.size() < others + kTimesWords || number_in(words[words.size() - 2])) words.clear();
    return words;
  }

  /// `largest`: of the words that may stand there in place of a stamp.
  static bool is_stamp_before_host(const std::vector<std::string_view>& words, double largest) {
    const auto before_host = number_in(words[words.size() - 3]);
    return !before_host || std::abs(*before_host) > largest;
  }

  [[noreturn]] void refuse_count(std::size_t announced, const char* what, std::size_t there) const {
    refuse(counted(announced, what) + " announced, " + std::to_string(there) + " there");
  }

  static std::optional<std::size_t> count_in(std::string_view word) {
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_count =
        error == std::errc{} && end == word.data() + word.size() && value >= 0 && value <= kMaxReadings;
    return is_count ? std::optional{static_cast<std::size_t>(value)} : std::nullopt;
  }

  static std::optional<double> number_in(std::string_view word) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_whole = error == std::errc{} && end == word.data() + word.size() && std::isfinite(value);
    return is_whole ? std::optional{value} : std::nullopt;
  }

  /// Seconds in decimal digits to whole nanoseconds: a double would round them at a tenth of a microsecond. Only
  /// "1.13486e+09" has no more digits than a double.
  Timestamp time(const char* name) {
    const std::string_view found = word(name);
    if (found.find_first_of("eE") != std::string_view::npos) {
      const auto value_s = number_in(found);
      if (!value_s || *value_s < 0.0 || *value_s > static_cast<double>(kMaxSeconds)) {
        refuse_word(name, found, "a time in seconds");
      }
      return Timestamp{} + duration_from_seconds(*value_s);
    }
    const char* const last = found.data() + found.size();
    std::int64_t whole_s = 0;
    auto [at, error] = std::from_chars(found.data(), last, whole_s);
    if (error != std::errc{} || whole_s < 0 || whole_s > kMaxSeconds) refuse_word(name, found, "a time in seconds");
    std::int64_t fraction_ns = 0;
    if (at != last && *at == '.') {
      std::int64_t digit_ns = 100'000'000;
      for (++at; at != last && *at >= '0' && *at <= '9'; ++at, digit_ns /= 10) fraction_ns += (*at - '0') * digit_ns;
    }
    if (at != last) refuse_word(name, found, "a time in seconds");
    return timestamp_from_ns(whole_s * 1'000'000'000 + fraction_ns);
  }

  [[noreturn]] void refuse_number(const char* name, const char* of, double value, const char* unit) const {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%g", value);
    refuse(std::string("'") + name + "' has a " + of + " of " + text + " " + unit + ": do the line's counts fit?");
  }

  [[noreturn]] void refuse_word(const char* name, std::string_view found, const char* expected) const {
    refuse(std::string("'") + name + "' must be " + expected + ", not '" + std::string(found.substr(0, 40)) + "'");
  }

  std::string_view text_;
  std::string place_;
  HeadingUnit headings_;
};

void read_ranges(Words& words, int count, CarmenScan& scan) {
  scan.ranges_m.resize(static_cast<std::size_t>(count));
  for (double& range_m : scan.ranges_m) {
    range_m = words.number("range");
    if (std::isfinite(range_m) && range_m >= 0.0) continue;
    range_m = 0.0;
    ++scan.not_numbers;
  }
}

/// FLASER states only the number of its values: CARMEN takes 101, 201 and 401 for the 100° variants of the LMS and all
/// else for 180°, where 180 and 360 values are those of 1° and 0.5° without the last one.
void guess_bearings(CarmenScan& scan) {
  const std::size_t n = scan.ranges_m.size();
  const bool narrow = n == 101 || n == 201 || n == 401;
  const double field_rad = radians(narrow ? 100.0 : 180.0);
  const std::size_t steps = n == 180 || n == 360 ? n : n - 1;
  scan.has_guessed_field = !narrow && n != 180 && n != 181 && n != 360 && n != 361 && n != 721;
  scan.first_bearing_rad = -field_rad / 2.0;
  scan.bearing_step_rad = field_rad / static_cast<double>(steps);
}

CarmenPoses read_poses(Words& words) {
  const Words::Posed laser = words.pose("laser pose");
  const Words::Posed robot = words.pose("robot pose");
  return {laser.pose, robot.pose, laser.heading, robot.heading};
}

CarmenScan read_flaser(Words& words) {
  CarmenScan scan;
  const int count = words.count("number of ranges");
  if (count < 2) words.refuse("FLASER needs at least 2 ranges");
  words.require_count(count, kPoseWords);
  read_ranges(words, count, scan);
  guess_bearings(scan);
  scan.poses = read_poses(words);
  scan.times = words.times();
  return scan;
}

/// The part that RAWLASER1 and ROBOTLASER1 share: configuration, ranges, remissions. `words_after`: up to the stamp.
CarmenScan read_configured_scan(Words& words, std::size_t words_after) {
  CarmenScan scan;
  (void)words.finite("laser type");
  scan.first_bearing_rad = words.finite("start angle");
  (void)words.finite("field of view");
  scan.bearing_step_rad = words.finite("angular resolution");
  const double max_range_m = words.finite("maximum range");
  if (max_range_m > 0.0) scan.stated_max_range_m = max_range_m;
  (void)words.finite("accuracy");
  (void)words.finite("remission mode");
  const int count = words.count("number of ranges");
  if (count < 2) words.refuse("a scan needs at least 2 ranges");
  if (!(scan.bearing_step_rad > 0.0) || scan.bearing_step_rad * (count - 1) > 2.0 * std::numbers::pi + 0.01) {
    words.refuse("'angular resolution' does not fit " + std::to_string(count) + " ranges");
  }
  words.require_counts(count, words_after);
  read_ranges(words, count, scan);
  const int remissions = words.count("number of remissions");
  for (int i = 0; i < remissions; ++i) (void)words.number("remission");
  return scan;
}

CarmenScan read_rawlaser(Words& words) {
  CarmenScan scan = read_configured_scan(words, 0);
  scan.times = words.times();
  return scan;
}

CarmenScan read_robotlaser(Words& words) {
  CarmenScan scan = read_configured_scan(words, kPoseWords + kMotionWords);
  scan.poses = read_poses(words);
  for (const char* name : {"tv", "rv", "forward safety", "side safety", "turn axis"}) (void)words.number(name);
  scan.times = words.times();
  return scan;
}

CarmenOdometry read_odometry(Words& words) {
  CarmenOdometry odometry;
  const Words::Posed robot = words.pose("pose");
  odometry.odom_from_robot = robot.pose;
  odometry.heading = robot.heading;
  odometry.speed_m_per_s = words.finite("tv");
  odometry.turn_rate_rad_per_s = words.finite("rv");
  (void)words.number("acceleration");
  odometry.times = words.times();
  return odometry;
}

std::optional<CarmenRecord> read_record(std::string_view kind, Words& words) {
  if (kind == "FLASER") return read_flaser(words);
  if (kind == "ROBOTLASER1") return read_robotlaser(words);
  if (kind == "RAWLASER1") return read_rawlaser(words);
  if (kind == "ODOM") return read_odometry(words);
  return std::nullopt;
}

}  // namespace

std::string_view kind_of(std::string_view line) { return line.substr(0, line.find_first_of(" \t\r")); }

std::optional<CarmenRecord> record_in(std::string_view line, const std::string& place, HeadingUnit headings) {
  const std::string_view kind = kind_of(line);
  Words words{line.substr(kind.size()), place, headings};
  auto record = read_record(kind, words);
  if (record) words.require_end();
  return record;
}

Timestamp CarmenClock::time_of(const CarmenTimes& times) const {
  if (!by_logger) return times.stamp.value_or(Timestamp{});
  return times.logger ? std::max(Timestamp{}, logger_began + *times.logger) : Timestamp{};
}

}  // namespace deltamap::drivers::carmen
