// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/files/foreign_file.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr std::size_t kMaxLineBytes = 1u << 20;  // a scan of 361 values takes 3 kB
constexpr int kMaxReadings = 65536;
constexpr std::array kTimeWords{"time stamp", "host", "logger time"};
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // the year 2255: a Timestamp ends soon after

/// Takes the words of a line one by one; says what was expected where one is missing or broken.
class Words {
 public:
  Words(std::string_view text, std::string place) : text_{text}, place_{std::move(place)} {}

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
    int value = 0;
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc{} || end != found.data() + found.size() || value < 0 || value > kMaxReadings) {
      refuse_word(name, found, "a count");
    }
    return value;
  }

  Pose2 pose(const char* name) {
    const double x = finite(name);
    const double y = finite(name);
    return {x, y, wrapped_angle(finite(name))};
  }

  [[nodiscard]] bool at_end() const { return text_.find_first_not_of(" \t\r") == std::string_view::npos; }

  /// The words after a record's own: stamp, host, logger's time. Some logs have no stamp, or nothing at all.
  CarmenTimes times() {
    CarmenTimes times;
    for (Words left = *this; !left.at_end() && times.words < 3; ++times.words) (void)left.word("time");
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

  [[noreturn]] void refuse_word(const char* name, std::string_view found, const char* expected) const {
    refuse(std::string("'") + name + "' must be " + expected + ", not '" + std::string(found.substr(0, 40)) + "'");
  }

  std::string_view text_;
  std::string place_;
};

std::vector<double> ranges(Words& words, int count) {
  std::vector<double> ranges_m(static_cast<std::size_t>(count));
  for (double& range_m : ranges_m) {
    range_m = words.number("range");
    if (!std::isfinite(range_m) || range_m < 0.0) range_m = 0.0;
  }
  return ranges_m;
}

/// FLASER states only the number of its values: CARMEN takes 101, 201 and 401 for the 100° variants of the LMS and all
/// else for 180°, where 180 and 360 values are those of 1° and 0.5° without the last one.
void guess_bearings(CarmenScan& scan) {
  const std::size_t n = scan.ranges_m.size();
  const bool narrow = n == 101 || n == 201 || n == 401;
  const double field_rad = radians(narrow ? 100.0 : 180.0);
  const std::size_t steps = n == 180 || n == 360 ? n : n - 1;
  scan.first_bearing_rad = -field_rad / 2.0;
  scan.bearing_step_rad = field_rad / static_cast<double>(steps);
}

CarmenScan read_flaser(Words& words) {
  CarmenScan scan;
  const int count = words.count("number of ranges");
  if (count < 2) words.refuse("FLASER needs at least 2 ranges");
  scan.ranges_m = ranges(words, count);
  guess_bearings(scan);
  CarmenPoses poses;
  poses.odom_from_laser = words.pose("laser pose");
  poses.odom_from_robot = words.pose("robot pose");
  scan.poses = poses;
  scan.times = words.times();
  return scan;
}

/// The part that RAWLASER1 and ROBOTLASER1 share: configuration, ranges, remissions.
CarmenScan read_configured_scan(Words& words) {
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
  scan.ranges_m = ranges(words, count);
  const int remissions = words.count("number of remissions");
  for (int i = 0; i < remissions; ++i) (void)words.number("remission");
  return scan;
}

CarmenScan read_rawlaser(Words& words) {
  CarmenScan scan = read_configured_scan(words);
  scan.times = words.times();
  return scan;
}

CarmenScan read_robotlaser(Words& words) {
  CarmenScan scan = read_configured_scan(words);
  CarmenPoses poses;
  poses.odom_from_laser = words.pose("laser pose");
  poses.odom_from_robot = words.pose("robot pose");
  scan.poses = poses;
  for (const char* name : {"tv", "rv", "forward safety", "side safety", "turn axis"}) (void)words.number(name);
  scan.times = words.times();
  return scan;
}

CarmenOdometry read_odometry(Words& words) {
  CarmenOdometry odometry;
  odometry.odom_from_robot = words.pose("pose");
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

[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

}  // namespace

Timestamp CarmenClock::time_of(const CarmenTimes& times) const {
  if (!by_logger) return times.stamp.value_or(Timestamp{});
  return times.logger ? std::max(Timestamp{}, logger_began + *times.logger) : Timestamp{};
}

CarmenLog::CarmenLog(std::filesystem::path file, const CarmenClock& clock) : file_{std::move(file)}, clock_{clock} {
  if (std::filesystem::is_directory(file_)) refuse_file(file_, "is a directory");
  in_.open(file_, std::ios::binary);
  if (!in_) refuse_file(file_, std::generic_category().message(errno));
  std::string head(4096, '\0');
  in_.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in_.gcount()));
  if (head.empty()) refuse_file(file_, "line 1: the file is empty");
  if (const std::string kind = foreign_kind(file_, head, WantedFile::kLog); !kind.empty()) refuse_file(file_, kind);
  in_.clear();
  in_.seekg(0, std::ios::end);
  size_bytes_ = static_cast<std::uint64_t>(in_.tellg());
  in_.seekg(0);
}

bool CarmenLog::read_line() {
  text_.clear();
  is_text_ = true;
  is_ended_ = false;
  const std::uint64_t before = read_bytes_;
  std::streambuf& bytes = *in_.rdbuf();
  while (!is_ended_) {
    const int next = bytes.sbumpc();
    if (next == std::char_traits<char>::eof()) break;
    ++read_bytes_;
    is_ended_ = next == '\n';
    is_text_ = is_text_ && next != '\0' && text_.size() < kMaxLineBytes;
    if (!is_ended_ && is_text_) text_ += static_cast<char>(next);
  }
  const bool found = read_bytes_ > before;
  if (found) ++line_;
  return found;
}

std::optional<CarmenRecord> CarmenLog::record_of_line() {
  const std::string place = file_.string() + ":" + std::to_string(line_);
  if (!is_text_) throw std::runtime_error(place + ": not a CARMEN log (not text)");
  const std::string_view text{text_};
  const std::size_t kind_end = std::min(text.find_first_of(" \t\r"), text.size());
  Words words{text.substr(kind_end), place};
  const std::string_view kind = text.substr(0, kind_end);
  auto record = read_record(kind, words);
  if (!record) return std::nullopt;
  std::visit(
      [&](auto& held) {
        const std::size_t usual = time_words_.emplace(kind, held.times.words).first->second;
        if (held.times.words < usual)
          words.refuse(std::string("cut short: '") + kTimeWords[held.times.words] + "' is missing");
        // A last number without a line end may be cut. It does no harm where it is a logger time that the log's clock
        // does not use.
        const bool is_whole = held.times.stamp && held.times.logger && !clock_.by_logger;
        if (!is_ended_ && !is_whole) words.refuse("cut short: its end is missing");
        held.line = line_;
        held.time = clock_.time_of(held.times);
      },
      *record);
  return record;
}

/// True where a readable record follows a broken line, which is then damage and not the end of the log.
bool CarmenLog::record_follows() {
  while (read_line()) {
    try {
      if (record_of_line()) return true;
    } catch (const std::runtime_error&) {  // broken as well
    }
  }
  return false;
}

std::optional<CarmenRecord> CarmenLog::next() {
  try {
    while (!cut_ && read_line()) {
      auto record = record_of_line();
      if (!record) continue;
      ++records_;
      return record;
    }
  } catch (const std::runtime_error& broken) {
    const std::string why = broken.what();
    if (records_ == 0 || record_follows()) throw;
    cut_ = why + "; the log ends there, the " + std::to_string(records_) + " scans and poses before it are used";
  }
  if (records_ == 0) {
    throw std::runtime_error(file_.string() + ":" + std::to_string(line_) +
                             ": not a CARMEN log: no FLASER, ROBOTLASER1, RAWLASER1 or ODOM line");
  }
  return std::nullopt;
}

}  // namespace deltamap::drivers::carmen
