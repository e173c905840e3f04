// SPDX-License-Identifier: Apache-2.0
#include "daemon/tool/carmen_log.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace deltamap::daemon::tool {
namespace {

constexpr std::size_t kMaxLineBytes = 1u << 20;  // a scan of 361 values takes 3 kB
constexpr int kMaxReadings = 65536;
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

  /// Seconds in decimal digits to whole nanoseconds: a double would round them at a tenth of a microsecond.
  Timestamp time(const char* name) {
    const std::string_view found = word(name);
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

  Pose2 pose(const char* name) {
    const double x = finite(name);
    const double y = finite(name);
    return {x, y, wrapped_angle(finite(name))};
  }

 private:
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

void skip_host_and_logger_time(Words& words) {
  (void)words.word("host");
  (void)words.word("logger time");
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
  scan.time = words.time("time stamp");
  skip_host_and_logger_time(words);
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
  scan.time = words.time("time stamp");
  skip_host_and_logger_time(words);
  return scan;
}

CarmenScan read_robotlaser(Words& words) {
  CarmenScan scan = read_configured_scan(words);
  CarmenPoses poses;
  poses.odom_from_laser = words.pose("laser pose");
  poses.odom_from_robot = words.pose("robot pose");
  scan.poses = poses;
  for (const char* name : {"tv", "rv", "forward safety", "side safety", "turn axis"}) (void)words.number(name);
  scan.time = words.time("time stamp");
  skip_host_and_logger_time(words);
  return scan;
}

CarmenOdometry read_odometry(Words& words) {
  CarmenOdometry odometry;
  odometry.odom_from_robot = words.pose("pose");
  odometry.speed_m_per_s = words.finite("tv");
  odometry.turn_rate_rad_per_s = words.finite("rv");
  (void)words.number("acceleration");
  odometry.time = words.time("time stamp");
  skip_host_and_logger_time(words);
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

CarmenLog::CarmenLog(std::filesystem::path file) : file_{std::move(file)} {
  if (std::filesystem::is_directory(file_)) refuse_file(file_, "is a directory");
  in_.open(file_, std::ios::binary);
  if (!in_) refuse_file(file_, std::generic_category().message(errno));
  std::string magic(6, '\0');
  in_.read(magic.data(), 6);
  magic.resize(static_cast<std::size_t>(in_.gcount()));
  if (magic.empty()) refuse_file(file_, "line 1: the file is empty");
  if (magic == std::string("\xFD"
                           "7zXZ\0",
                           6))
    refuse_file(file_, "is xz-compressed; unpack it first (xz -dk)");
  if (magic.starts_with("\x1F\x8B")) refuse_file(file_, "is gzip-compressed; unpack it first (gunzip -k)");
  in_.clear();
  in_.seekg(0, std::ios::end);
  size_bytes_ = static_cast<std::uint64_t>(in_.tellg());
  in_.seekg(0);
}

bool CarmenLog::read_line() {
  text_.clear();
  char c = '\0';
  std::streambuf& bytes = *in_.rdbuf();
  for (;;) {
    const int next = bytes.sbumpc();
    if (next == std::char_traits<char>::eof()) break;
    ++read_bytes_;
    c = static_cast<char>(next);
    if (c == '\n') break;
    if (c == '\0' || text_.size() == kMaxLineBytes) {
      throw std::runtime_error(file_.string() + ":" + std::to_string(line_ + 1) + ": not a CARMEN log (not text)");
    }
    text_ += c;
  }
  const bool found = c == '\n' || !text_.empty();
  if (found) ++line_;
  return found;
}

std::optional<CarmenRecord> CarmenLog::next() {
  while (read_line()) {
    const std::string_view text{text_};
    const std::size_t kind_end = std::min(text.find_first_of(" \t\r"), text.size());
    Words words{text.substr(kind_end), file_.string() + ":" + std::to_string(line_)};
    auto record = read_record(text.substr(0, kind_end), words);
    if (!record) continue;
    ++records_;
    std::visit([this](auto& held) { held.line = line_; }, *record);
    return record;
  }
  if (records_ == 0) {
    throw std::runtime_error(file_.string() + ":" + std::to_string(line_) +
                             ": not a CARMEN log: no FLASER, ROBOTLASER1, RAWLASER1 or ODOM line");
  }
  return std::nullopt;
}

}  // namespace deltamap::daemon::tool
