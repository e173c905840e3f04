// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/recording_parts.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include "core/utc_text.hpp"
#include "drivers/port/byte_log.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

constexpr double kShare = 0.1;  // of what is kept
constexpr double kLargestBytes = 256e6;
constexpr double kLongestS = 3600.0;
constexpr double kSecondsAnHour = 3600.0;
constexpr std::size_t kTimeChars = 16;  // "20261130T030000Z"

bool is_time(const std::string& text) {
  if (text.size() < kTimeChars || text[8] != 'T' || text[15] != 'Z') return false;
  return std::count_if(text.begin(), text.begin() + 15, [](unsigned char c) { return std::isdigit(c) != 0; }) == 14;
}

/// Nothing where the file cannot be looked at.
std::optional<double> age_s(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  if (error) return std::nullopt;
  return std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count();
}

std::uint64_t size_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

bool is_part_full(const RingLimits& limits, std::uint64_t bytes, double lasted_s) {
  const double most_bytes =
      limits.keep_gigabytes > 0.0 ? std::min(kLargestBytes, kShare * limits.keep_gigabytes * 1e9) : kLargestBytes;
  const double most_s =
      limits.keep_hours > 0.0 ? std::min(kLongestS, kShare * limits.keep_hours * kSecondsAnHour) : kLongestS;
  return static_cast<double>(bytes) >= most_bytes || lasted_s >= most_s;
}

fs::path place_of_part(const fs::path& recording, Timestamp began) {
  const std::string time = utc_name(began);
  std::error_code error;
  for (int number = 1;; ++number) {
    const std::string suffix = number == 1 ? "" : "-" + std::to_string(number);
    fs::path place = recording;
    place.replace_extension("." + time + suffix + recording.extension().string());
    if (!fs::exists(place, error)) return place;
  }
}

std::vector<fs::path> parts_of(const fs::path& recording) {
  const std::string head = recording.stem().string() + ".";
  std::vector<fs::path> parts;
  std::error_code error;
  const fs::path folder = recording.has_parent_path() ? recording.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_part = name.starts_with(head) && entry.path().extension() == recording.extension() &&
                         is_time(name.substr(head.size()));
    if (is_part) parts.push_back(folder / name);
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

fs::path place_of_earlier(const fs::path& recording) {
  try {
    drivers::port::ByteLogReader reader{recording};
    if (const auto record = reader.next()) return place_of_part(recording, record->stamp);
  } catch (const std::runtime_error&) {  // damaged, or foreign: it is kept all the same
  }
  return place_of_part(recording,
                       drivers::port::port_clock_now() - duration_from_seconds(age_s(recording).value_or(0)));
}

void drop_oldest_parts(const fs::path& recording, const RingLimits& limits) {
  const std::vector<fs::path> parts = parts_of(recording);
  double bytes = static_cast<double>(size_of(recording));
  for (const fs::path& part : parts) bytes += static_cast<double>(size_of(part));
  for (const fs::path& part : parts) {
    const bool is_too_large = limits.keep_gigabytes > 0.0 && bytes > limits.keep_gigabytes * 1e9;
    const bool is_too_old = limits.keep_hours > 0.0 && age_s(part).value_or(0.0) > limits.keep_hours * kSecondsAnHour;
    if (!is_too_large && !is_too_old) return;
    bytes -= static_cast<double>(size_of(part));
    std::error_code ignored;
    fs::remove(part, ignored);
  }
}

}  // namespace deltamap::daemon
