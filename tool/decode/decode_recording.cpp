// SPDX-License-Identifier: Apache-2.0
#include "tool/decode/decode_recording.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <map>
#include <stdexcept>

#include "daemon/settings/reader/nearest_key.hpp"
#include "tool/decode/frame_text.hpp"
#include "tool/decode/recorded_frames.hpp"

namespace deltamap::tool {
namespace {

constexpr std::size_t kLongestList = 12;

std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

std::string_view direction_name(const RecordedFrame& frame) {
  if (frame.frame.name == kNoteName) return "note";
  return frame.line.direction == drivers::port::Direction::kIn ? "in" : "out";
}

/// Prints the frames of the wanted kinds, and counts all kinds that there are.
class FramePrinter {
 public:
  explicit FramePrinter(const RecordingToDecode& wanted) : wanted_{wanted} {
    for (const std::string& kind : wanted.kinds) kinds_.push_back(in_small_letters(kind));
  }

  void take(const RecordedFrame& frame) {
    if (frame.completed_s < wanted_.window.from_s || frame.completed_s > wanted_.window.to_s) return;
    ++met_[frame.frame.name];
    const bool is_wanted =
        kinds_.empty() || std::find(kinds_.begin(), kinds_.end(), in_small_letters(frame.frame.name)) != kinds_.end();
    if (is_wanted) wanted_.as_json ? print_json(frame) : print_text(frame);
  }

  /// Throws where a wanted kind was not met.
  void require_kinds() const {
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
      const bool is_met = std::any_of(met_.begin(), met_.end(),
                                      [&](const auto& one) { return in_small_letters(one.first) == kinds_[i]; });
      if (!is_met) throw std::runtime_error(wanted_.file + ": " + why_not(wanted_.kinds[i]));
    }
  }

 private:
  static void print_json(const RecordedFrame& frame) {
    char after[32];
    (void)std::snprintf(after, sizeof after, "%.9f", frame.after_s);
    const NamedFields head{{"name", frame.frame.name},
                           {"time_ns", whole(unix_ns(frame.time))},
                           {"port", std::string(name_of(frame.line.port))},
                           {"direction", std::string(direction_name(frame))},
                           {"bytes", whole(static_cast<std::int64_t>(frame.frame.size))}};
    std::string line = json_of(head);
    line.pop_back();
    std::cout << line << ",\"after_s\":" << after << ",\"fields\":" << json_of(frame.frame.fields) << "}\n";
  }

  static void print_text(const RecordedFrame& frame) {
    char after[32];
    (void)std::snprintf(after, sizeof after, "%.6f s  ", frame.after_s);
    std::cout << after << frame.frame.name << "  (" << name_of(frame.line.port);
    if (frame.frame.name != kNoteName)
      std::cout << ", " << direction_name(frame) << ", " << frame.frame.size << " bytes";
    std::cout << ")\n" << text_of(frame.frame.fields, kLongestList);
  }

  [[nodiscard]] std::string why_not(const std::string& kind) const {
    std::string names;
    std::vector<std::string> all;
    for (const auto& [name, count] : met_) {
      names += (names.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ")";
      all.push_back(name);
    }
    if (names.empty()) return "holds no frame in this window";
    const auto nearest = daemon::nearest_of(all, kind);
    return "holds no '" + kind + "' in this window" + (nearest ? " (nearest kind " + *nearest + ")" : "") +
           "; there are " + names;
  }

  const RecordingToDecode& wanted_;
  std::vector<std::string> kinds_;  // in small letters
  std::map<std::string, std::uint64_t> met_;
};

}  // namespace

void decode_recording(const RecordingToDecode& wanted) {
  drivers::port::ByteLogReader reader{wanted.file};
  FramePrinter printer{wanted};
  RecordedFrames frames{wanted.measuring_mode, [&](const RecordedFrame& frame) { printer.take(frame); }};
  while (const auto record = reader.next()) frames.feed(*record);
  for (const std::string& line : reader.faults().lines()) std::cerr << "deltamap: warning: " << line << '\n';
  printer.require_kinds();
}

}  // namespace deltamap::tool
