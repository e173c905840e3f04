// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/counted.hpp"
#include "core/files/foreign_file.hpp"
#include "core/files/text_of_file.hpp"
#include "core/geometry/angle.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr std::size_t kMaxLineBytes = 1u << 20;  // a scan of 361 values takes 3 kB
constexpr std::size_t kMostToldLines = 3;        // of the broken ones; the others are counted
constexpr std::array kTimeWords{"time stamp", "host", "logger time"};

[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

}  // namespace

CarmenLog::CarmenLog(std::filesystem::path file, const CarmenClock& clock, HeadingUnit headings)
    : file_{std::move(file)}, clock_{clock}, headings_{headings} {
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
  if (read_bytes_ == before) return false;
  if (++line_ == 1 && text_.starts_with(kUtf8Mark)) text_.erase(0, kUtf8Mark.size());
  return true;
}

std::optional<CarmenRecord> CarmenLog::record_of_line() {
  const std::string place = file_.string() + ":" + std::to_string(line_);
  if (!is_text_) throw std::runtime_error(place + ": not a CARMEN log (not text)");
  auto record = record_in(text_, place, headings_);
  if (!record) {
    look_at_other(text_);
    return std::nullopt;
  }
  const auto refuse = [&](const std::string& why) { throw std::runtime_error(place + ": cut short: " + why); };
  std::visit(
      [&](auto& held) {
        const std::size_t usual = time_words_.emplace(kind_of(text_), held.times.words).first->second;
        if (held.times.words < usual) refuse(std::string("'") + kTimeWords[held.times.words] + "' is missing");
        // A last number without a line end may be cut. It does no harm where it is a logger time that the log's clock
        // does not use.
        const bool is_whole = held.times.stamp && held.times.logger && !clock_.by_logger;
        if (!is_ended_ && !is_whole) refuse("its end is missing");
        held.line = line_;
      },
      *record);
  return record;
}

/// Lasers that are not read, and where the log says that its laser is.
void CarmenLog::look_at_other(std::string_view text) {
  const std::string_view kind = kind_of(text);
  if (kind.find("LASER") != std::string_view::npos && kind.front() != '#') ++faults_.others[std::string(kind)];
  if (kind == "PARAM") look_at_parameter(text);
}

/// "PARAM NAME VALUE …". Angles are radians, as all of CARMEN's; what is more than a turn can only be degrees.
void CarmenLog::look_at_parameter(std::string_view text) {
  std::array<std::string_view, 3> words;
  for (std::string_view& word : words) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    word = kind_of(text);
    text.remove_prefix(word.size());
  }
  double value = 0.0;
  const char* const last = words[2].data() + words[2].size();
  const auto [end, error] = std::from_chars(words[2].data(), last, value);
  if (error != std::errc{} || end != last || !std::isfinite(value)) return;
  if (words[1] == "robot_frontlaser_offset") faults_.stated_mount.x_m = value;
  if (words[1] == "robot_frontlaser_side_offset") faults_.stated_mount.y_m = value;
  if (words[1] == "robot_frontlaser_angular_offset")
    faults_.stated_mount.yaw_rad = std::abs(value) > 2.0 * std::numbers::pi ? radians(value) : value;
}

void CarmenLog::keep_broken(const std::string& why) {
  ++lines_since_record_;
  if (broken_since_record_.size() < kMostToldLines) broken_since_record_.push_back(why);
}

/// Broken lines that no record follows are where the log was cut.
void CarmenLog::end() {
  is_over_ = true;
  if (records_ == 0 && lines_since_record_ > 0) throw std::runtime_error(broken_since_record_.front());
  if (records_ == 0) {
    std::string others;
    for (const auto& [kind, count] : faults_.others) others += ", only " + std::to_string(count) + " of " + kind;
    throw std::runtime_error(file_.string() + ":" + std::to_string(line_) +
                             ": not a CARMEN log: no FLASER, ROBOTLASER1, RAWLASER1 or ODOM line" + others);
  }
  if (lines_since_record_ == 0) return;
  cut_ = broken_since_record_.front() + "; the log ends there, the " +
         counted(records_, "scan or pose before it is used", "scans and poses before it are used");
}

std::optional<CarmenRecord> CarmenLog::next() {
  while (!is_over_ && read_line()) {
    try {
      auto record = record_of_line();
      if (!record) continue;
      std::visit(
          [&](auto& held) {
            constexpr bool kIsScan = std::is_same_v<std::decay_t<decltype(held)>, CarmenScan>;
            std::optional<CarmenTimeline::ScanKind> scan;
            if constexpr (kIsScan) scan = {kind_of(text_), held.poses.has_value()};
            const auto placed = timeline_.place(clock_.time_of(held.times), held.times, scan, line_);
            held.time = placed.time;
            if constexpr (kIsScan) held.is_repeated = placed.is_repeated;
          },
          *record);
      ++records_;
      faults_.broken_lines += std::exchange(lines_since_record_, 0);
      for (std::string& why : broken_since_record_) {
        if (faults_.broken.size() < kMostToldLines) faults_.broken.push_back(std::move(why));
      }
      broken_since_record_.clear();
      return record;
    } catch (const std::runtime_error& broken) {
      keep_broken(broken.what());
    }
  }
  if (!is_over_) end();
  return std::nullopt;
}

CarmenFaults CarmenLog::faults() const {
  CarmenFaults faults = faults_;
  faults.clock = timeline_.clock_notes();
  faults.repeats = timeline_.repeat_notes();
  return faults;
}

}  // namespace deltamap::drivers::carmen
