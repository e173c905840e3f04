// SPDX-License-Identifier: Apache-2.0
#include "tool/info/info_text.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "core/geometry/angle.hpp"
#include "core/utc_text.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/settings/fingerprint.hpp"

namespace deltamap::tool {
namespace {

constexpr std::size_t kShown = 5;  // of gaps, orders and the like

__attribute__((format(printf, 1, 2))) std::string text_from(const char* format, ...) {
  char text[256];
  std::va_list values;
  va_start(values, format);
  (void)std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

/// "a; b; c", of many the first and how many more there are.
std::string listed(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size() && i < kShown; ++i) text += (i == 0 ? "" : "; ") + all[i];
  return all.size() > kShown ? text + "; and " + std::to_string(all.size() - kShown) + " more" : text;
}

std::string without_blanks_behind(std::string text) {
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string text_of(const ToldValues& told, const std::string& before, const std::string& behind) {
  if (told.changes.empty()) return {};
  std::string text;
  for (const auto& [after_s, value] : told.changes) {
    const bool is_first = text.empty();
    text.append(", ").append(is_first ? before : "").append(value);
    text.append(is_first ? behind : text_from(" from %.1f s", after_s));
  }
  return text;
}

std::string text_of(const std::map<std::string, std::uint64_t>& counts) {
  std::string text;
  for (const auto& [name, count] : counts) text += (text.empty() ? "" : ", ") + name + " " + std::to_string(count);
  return text;
}

std::string text_of(const Rhythm& rhythm, const std::string& what) {
  const double period_s = rhythm.period_s();
  if (rhythm.count() == 0) return "no " + what;
  std::string text = what + " " + std::to_string(rhythm.count());
  if (period_s > 0.0) text += text_from(", one every %.1f ms (%.2f a second)", period_s * 1e3, 1.0 / period_s);
  if (rhythm.missing() > 0) text += ", " + std::to_string(rhythm.missing()) + " missing between";
  return text;
}

std::string broken_text(const TrafficSurvey& traffic) {
  const drivers::DecoderCounts& counts = traffic.counts;
  const std::map<std::string, std::uint64_t> all{{"bytes of no frame", counts.garbage_bytes},
                                                 {"impossible lengths", counts.bad_length},
                                                 {"wrong checksums", counts.bad_checksum},
                                                 {"cut short", counts.truncated}};
  std::map<std::string, std::uint64_t> met;
  for (const auto& [name, count] : all) {
    if (count > 0) met[name] = count;
  }
  return text_of(met);
}

std::string robot_text(const RecordingSurvey& survey) {
  std::string text = "its name is not told";
  if (survey.identity) {
    text = survey.identity->type + " " + survey.identity->subtype + " \"" + survey.identity->name + "\"";
  }
  if (survey.config && !survey.config->firmware_version.empty())
    text += ", firmware " + survey.config->firmware_version;
  return text + text_of(survey.robot_port().bauds, "", " baud");
}

std::string laser_text(const RecordingSurvey& survey) {
  const LaserSurvey& laser = survey.laser;
  std::string text = laser.type.empty() ? "LMS2xx" : laser.type;
  if (laser.status) text += ", software " + without_blanks_behind(laser.status->software_version);
  text += laser.variants.changes.empty() ? ", its variant is not told" : text_of(laser.variants, "", "");
  text += text_of(laser.units, "", "") + text_of(laser.measuring_modes, "measuring mode ", "");
  return text + text_of(survey.laser_port().bauds, "", " baud");
}

std::vector<std::string> silence_texts(const std::vector<Silence>& silences, const char* format) {
  std::vector<std::string> texts;
  texts.reserve(silences.size());
  for (const Silence& one : silences) texts.push_back(text_from(format, one.length_s, one.after_s));
  return texts;
}

std::vector<std::string> command_texts(const RecordingSurvey& survey) {
  std::vector<std::string> texts;
  for (const daemon::Decision& command : survey.run.journal.commands()) {
    if (is_of_begin(command)) continue;
    std::string text = words_of_command(command) + " before scan " + std::to_string(command.scan);
    if (command.scan_time && survey.first) text += text_from(", %.1f s", seconds(*command.scan_time - *survey.first));
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string run_text(const RecordingSurvey& survey) {
  const auto& run = survey.run.journal.run();
  if (!run) return {};
  std::string text = "settings " + daemon::hex_of(run->settings) + ", map " + daemon::hex_of(run->map);
  const auto& begin = survey.run.begin.begin();
  if (begin && begin->start.revision > 0) text += ", revision " + std::to_string(begin->start.revision);
  if (begin) text += ", what an earlier run has kept";
  if (const std::string words = words_of_begin(survey); !words.empty()) text += ", begins with " + words;
  return text;
}

class InfoLines {
 public:
  void add(const std::string& label, const std::string& text) {
    if (text.empty()) return;
    const std::string shown = label == last_ ? "" : label;
    last_ = label;
    text_ += "  " + shown + std::string(shown.size() < kWidth ? kWidth - shown.size() : 1, ' ') + text + "\n";
  }
  void add(const std::string& label, const std::vector<std::string>& texts) { add(label, listed(texts)); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t kWidth = 10;
  std::string last_;
  std::string text_;
};

void add_port(const PortSurvey& port, const std::string& name, const std::string& what, InfoLines& lines) {
  lines.add(name, text_of(port.rhythm, what));
  lines.add(name, port.said.frames.empty() ? "" : "from it: " + text_of(port.said.frames));
  lines.add(name, port.heard.frames.empty() ? "" : "to it: " + text_of(port.heard.frames));
  if (const std::string broken = broken_text(port.said); !broken.empty()) lines.add(name, "from it, broken: " + broken);
  if (const std::string broken = broken_text(port.heard); !broken.empty()) lines.add(name, "to it, broken: " + broken);
  lines.add(name, silence_texts(port.rhythm.silences(), "silent for %.1f s from %.1f s on"));
  if (port.sessions_s.size() > 1) lines.add(name, std::to_string(port.sessions_s.size()) + " sessions: connected anew");
}

}  // namespace

std::string words_of_command(const daemon::Decision& command) {
  using Kind = daemon::Decision::Kind;
  const Pose2& pose = command.map_from_robot;
  switch (command.kind) {
    case Kind::kPaused:
      return "mapping paused";
    case Kind::kResumed:
      return "mapping resumed";
    case Kind::kRelocalized:
      return text_from("relocalized to %.3f, %.3f, %.1f°", pose.x, pose.y, degrees(pose.theta));
    case Kind::kMapSet:
      return daemon::reason_of(command.set->order);
    case Kind::kSiteSet:
      return "bays: " + std::to_string(command.site->bays.size()) +
             ", zones: " + std::to_string(command.site->zones.size());
    default:
      return {};
  }
}

bool is_of_begin(const daemon::Decision& command) {
  return command.kind == daemon::Decision::Kind::kSiteSet && command.scan == 0;
}

std::string words_of_begin(const RecordingSurvey& survey) {
  const auto& commands = survey.run.journal.commands();
  const auto begin = std::find_if(commands.begin(), commands.end(), is_of_begin);
  return begin == commands.end() ? "" : words_of_command(*begin);
}

RepeatAnswer repeat_answer(const RecordingSurvey& survey) {
  const std::string why = daemon::why_never_obeyed(survey.run);
  if (why == "none") return {false, "no run of the daemon stands in it: a replay decides by itself"};
  if (!why.empty()) return {false, why};
  return {true, std::string("with the run's settings and map (--config and --map here tell whether they are)") +
                    (survey.run.faults.lacks_end ? "; as far as it goes: its end is missing" : "")};
}

std::string info_text(const RecordingSurvey& survey, const RepeatAnswer& repeat) {
  InfoLines lines;
  lines.add("robot", robot_text(survey));
  add_port(survey.robot_port(), "robot", "SIPs", lines);
  lines.add("laser", laser_text(survey));
  add_port(survey.laser_port(), "laser", "scans", lines);
  lines.add("clock", silence_texts(survey.set_back, "set back by %.3f s at %.1f s"));
  lines.add("clock", silence_texts(survey.common_silences(),
                                   "both devices silent for %.1f s from %.1f s on: a pause, or the clock set forward"));
  std::vector<std::string> lost;
  for (const double after_s : survey.lost_s) lost.push_back(text_from("records missing at %.1f s", after_s));
  lines.add("lost", lost);
  lines.add("lost", survey.dropped.empty() ? "" : "by the daemon, for want of time: " + text_of(survey.dropped));
  for (const std::string& line : survey.run.faults.lines()) lines.add("lost", line);
  lines.add("operator", command_texts(survey));
  lines.add("run", run_text(survey));
  for (const auto& [key, value] : survey.settings) lines.add("run", std::string(key).append(": ").append(value));
  lines.add("replay", (repeat.can ? "bit for bit: " : "not bit for bit: ") + repeat.why);
  std::string head = survey.file.string();
  head += text_from(": %.1f s", survey.length_s) + (survey.first ? " from " + utc_text(*survey.first) : "");
  return head + text_from(", %.2f MB, ", static_cast<double>(survey.size_bytes) / 1e6) +
         std::to_string(survey.records) + " packets, " + std::to_string(survey.notes) + " notes\n" + lines.text();
}

}  // namespace deltamap::tool
