// SPDX-License-Identifier: Apache-2.0
#include "tool/import/message_log.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace deltamap::tool {
namespace {

constexpr double kBeyondLongestM = 1.0;  // of what stands for no return: the scans' unit stays as fine as it is

template <typename Number>
void put(std::string& line, Number value) {
  std::array<char, 40> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  line += ' ';
  line.append(digits.data(), error == std::errc{} ? end : digits.data());
}

/// All digits of its nanoseconds.
void put_time(std::string& line, Timestamp time) {
  const std::int64_t ns = unix_ns(time);
  const std::string fraction = std::to_string(1'000'000'000 + ns % 1'000'000'000).substr(1);
  const std::string text = std::to_string(ns / 1'000'000'000) + '.' + fraction;
  line += ' ' + text + " ros " + text + '\n';
}

enum class BeamSays { kRange, kNoReturn, kNothing };

class LogLines {
 public:
  LogLines(const std::vector<RosScan>& scans, std::optional<double> no_return_m) : no_return_m_{no_return_m} {
    double longest_m = 0.0;
    for (const RosScan& scan : scans) {
      for (const float range_m : scan.ranges_m) {
        const BeamSays says = said_by(scan, range_m);
        if (says == BeamSays::kRange) longest_m = std::max(longest_m, static_cast<double>(range_m));
        written_.no_returns += says == BeamSays::kNoReturn ? 1 : 0;
        written_.not_valid += says == BeamSays::kNothing ? 1 : 0;
      }
    }
    stands_for_none_m_ = longest_m + kBeyondLongestM;
    if (written_.no_returns > 0) written_.no_return_m = longest_m + 0.5 * kBeyondLongestM;
  }

  [[nodiscard]] std::string line_of(const RosScan& scan) const {
    const std::size_t count = scan.ranges_m.size();
    const double step_rad = std::abs(scan.bearing_step_rad);
    const double span_rad = step_rad * static_cast<double>(count - 1);
    const bool is_clockwise = scan.bearing_step_rad < 0.0;
    std::string line = "RAWLASER1 0";
    put(line, is_clockwise ? scan.first_bearing_rad - span_rad : scan.first_bearing_rad);
    put(line, span_rad);
    put(line, step_rad);
    line += " 0 0 0";
    put(line, count);
    for (std::size_t i = 0; i < count; ++i) put_range(line, scan, scan.ranges_m[is_clockwise ? count - 1 - i : i]);
    line += " 0";
    put_time(line, scan.time);
    return line;
  }
  [[nodiscard]] const WrittenLog& written() const { return written_; }

 private:
  [[nodiscard]] BeamSays said_by(const RosScan& scan, float range_m) const {
    const auto range = static_cast<double>(range_m);
    if (std::isnan(range) || range <= 0.0 || range < scan.min_range_m) return BeamSays::kNothing;
    const bool is_far =
        (scan.max_range_m > 0.0 && range >= scan.max_range_m) || (no_return_m_ && range >= *no_return_m_);
    return std::isinf(range) || is_far ? BeamSays::kNoReturn : BeamSays::kRange;
  }
  void put_range(std::string& line, const RosScan& scan, float range_m) const {
    const BeamSays says = said_by(scan, range_m);
    if (says == BeamSays::kRange) return put(line, range_m);
    put(line, says == BeamSays::kNoReturn ? stands_for_none_m_ : 0.0);
  }

  std::optional<double> no_return_m_;
  double stands_for_none_m_ = 0.0;
  WrittenLog written_;
};

std::string line_of_pose(const RosPose& pose) {
  std::string line = "ODOM";
  for (const double value : {pose.at.pose.x, pose.at.pose.y, pose.at.pose.theta}) put(line, value);
  line += " 0 0 0";
  put_time(line, pose.time);
  return line;
}

template <typename Items>
void sort_by_time(Items& items) {
  std::stable_sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
}

}  // namespace

WrittenLog write_carmen_log(const std::filesystem::path& file, std::vector<RosScan>& scans, std::vector<RosPose>& poses,
                            std::optional<double> no_return_m) {
  sort_by_time(scans);
  sort_by_time(poses);
  const LogLines lines{scans, no_return_m};
  std::ofstream out{file, std::ios::binary};
  auto pose = poses.begin();
  for (const RosScan& scan : scans) {
    for (; pose != poses.end() && pose->time <= scan.time; ++pose) out << line_of_pose(*pose);
    out << lines.line_of(scan);
  }
  for (; pose != poses.end(); ++pose) out << line_of_pose(*pose);
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
  return lines.written();
}

std::optional<PlanarPose> mount_by(const std::vector<RosPose>& transforms, const std::string& laser_frame,
                                   const std::string& base) {
  constexpr int kLongestChain = 20;
  PlanarPose base_from_laser;
  std::string frame = laser_frame;
  for (int i = 0; i < kLongestChain && frame != base; ++i) {
    const auto found = std::find_if(transforms.begin(), transforms.end(),
                                    [&](const RosPose& transform) { return transform.child == frame; });
    if (found == transforms.end()) return std::nullopt;
    base_from_laser = found->at * base_from_laser;
    frame = found->frame;
  }
  return frame == base ? std::optional{base_from_laser} : std::nullopt;
}

}  // namespace deltamap::tool
