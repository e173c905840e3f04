// SPDX-License-Identifier: Apache-2.0
#include "tool/ctl/status_table.hpp"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/counted.hpp"

namespace deltamap::tool {
namespace {

using Json = nlohmann::ordered_json;

bool has_number(const Json& json, const char* path) {
  const auto found = Json::json_pointer(path);
  return json.contains(found) && json[found].is_number();
}

double number(const Json& json, const char* path) {
  return has_number(json, path) ? json[Json::json_pointer(path)].get<double>() : 0.0;
}

bool has_object(const Json& json, const char* name) { return json.contains(name) && json[name].is_object(); }

std::string word(const Json& json, const char* path) {
  const auto found = Json::json_pointer(path);
  return json.contains(found) && json[found].is_string() ? json[found].get<std::string>() : "-";
}

template <typename... Values>
std::string line(const char* name, const char* format, const Values&... values) {
  char head[16];
  char text[256];
  (void)std::snprintf(head, sizeof head, "%-13s", name);
  (void)std::snprintf(text, sizeof text, format, values...);
  return std::string(head) + text + "\n";
}

/// Nothing that only a scan tells is known before the first one.
bool has_pose(const Json& s) { return has_object(s, "pose"); }

std::string pose_line(const Json& s) {
  if (!has_pose(s)) return line("pose", "%s", "unknown");
  const double deviation_deg = std::sqrt(number(s, "/covariance/hh_rad2")) * 57.29577951308232;
  return line("pose", "x=%.2f y=%.2f m heading=%.1f deg (deviations %.3f, %.3f m, %.1f deg)", number(s, "/pose/x_m"),
              number(s, "/pose/y_m"), number(s, "/pose/heading_deg"), std::sqrt(number(s, "/covariance/xx_m2")),
              std::sqrt(number(s, "/covariance/yy_m2")), deviation_deg);
}

std::string belief_lines(const Json& s) {
  if (!has_object(s, "belief")) return line("belief", "%s", "none");
  std::string text = line("belief", "pose %s (right %.2f), map wrong here %.2f", word(s, "/belief/verdict").c_str(),
                          number(s, "/belief/pose_right"), number(s, "/belief/map_wrong"));
  text += line("", "beams that fit: %.0f of %.0f on what is stable, %.0f of %.0f elsewhere",
               number(s, "/belief/stable/fit"), number(s, "/belief/stable/expected"),
               number(s, "/belief/elsewhere/fit"), number(s, "/belief/elsewhere/expected"));
  if (number(s, "/belief/rival/share") <= 0.0) return text;
  return text + line("", "or else at x=%.2f y=%.2f m heading=%.0f deg (share %.2f)", number(s, "/belief/rival/x_m"),
                     number(s, "/belief/rival/y_m"), number(s, "/belief/rival/heading_deg"),
                     number(s, "/belief/rival/share"));
}

std::string map_line(const Json& s) {
  const double newest = number(s, "/newest_revision");
  return line("map", "revision %.0f (newest %.0f), %.0f refused, mapping %s, phase %.0f%s",
              has_number(s, "/revision") ? number(s, "/revision") : newest, newest, number(s, "/refused"),
              word(s, "/mapping").c_str(), number(s, "/phase/number"),
              s.value("/phase/open"_json_pointer, false) ? " open" : "");
}

/// How long nothing could be written, and why.
std::string gate_line(const Json& s) {
  std::string why;
  double shut_s = 0.0;
  if (const auto at = "/gate/shut_s"_json_pointer; s.contains(at) && s[at].is_object()) {
    for (const auto& [reason, time_s] : s[at].items()) {
      const double reason_s = time_s.is_number() ? time_s.get<double>() : 0.0;
      shut_s += reason_s;
      why += (why.empty() ? ": " : ", ") + reason + " " + std::to_string(std::lround(reason_s)) + " s";
    }
  }
  const bool open = s.value("/gate/open"_json_pointer, false);
  return line("write gate", "%s, shut %.0f of %.0f s%s", open ? "open" : ("shut, " + word(s, "/gate/reason")).c_str(),
              shut_s, number(s, "/gate/observed_s"), why.c_str());
}

std::string scans_line(const Json& s) {
  double drops = 0.0;
  if (has_object(s, "drops")) {
    for (const auto& count : s["drops"]) drops += count.is_number() ? count.get<double>() : 0.0;
  }
  std::string latency = "unknown";
  if (has_number(s, "/latency_ms")) {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.1f ms", number(s, "/latency_ms"));
    latency = text;
  }
  return line("scans", "%.0f, %.0f localized, %s dropped, latency %s", number(s, "/scans"), number(s, "/localized"),
              counted(static_cast<std::uint64_t>(drops), "message").c_str(), latency.c_str());
}

/// What driving has told of the wheels and of the laser's mount, with deviations.
std::string wheels_lines(const Json& s) {
  if (!s.contains("calibration") || !s["calibration"].is_object()) return line("wheels", "%s", "nothing found yet");
  const auto found = [&](const std::string& what) { return number(s, ("/calibration" + what).c_str()); };
  const auto unsure = [&](const std::string& what) { return found("/deviations" + what); };
  return line("wheels", "distance %+.2f ± %.2f %%, turn %+.2f ± %.2f %%, drift %+.3f ± %.3f deg/m, lag %.0f ± %.0f ms",
              found("/distance_percent"), unsure("/distance_percent"), found("/turn_percent"), unsure("/turn_percent"),
              found("/drift_deg_per_m"), unsure("/drift_deg_per_m"), found("/lag_ms"), unsure("/lag_ms")) +
         line("laser mount", "off by x %+.0f ± %.0f, y %+.0f ± %.0f mm, yaw %+.2f ± %.2f deg", found("/mount/x_mm"),
              unsure("/mount/x_mm"), found("/mount/y_mm"), unsure("/mount/y_mm"), found("/mount/yaw_deg"),
              unsure("/mount/yaw_deg"));
}

std::string utc_clock(double unix_s) {
  const auto whole = static_cast<std::time_t>(unix_s);
  std::tm calendar{};
  char text[32];
  (void)std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", gmtime_r(&whole, &calendar));
  return text;
}

/// All that is well in one line; what is not written in a line of its own.
std::string outputs_lines(const Json& s) {
  if (!s.contains("outputs") || !s["outputs"].is_object() || s["outputs"].empty())
    return line("saving", "%s", "nothing");
  std::string written;
  std::string paused;
  for (const auto& [name, output] : s["outputs"].items()) {
    if (output.value("written", true)) {
      written += (written.empty() ? "" : ", ") + name;
    } else {
      paused +=
          line("", "%s",
               (name + " not since " + utc_clock(number(output, "/since")) + " UTC: " + word(output, "/why")).c_str());
    }
  }
  return line("saving", "%s", written.empty() ? "nothing" : written.c_str()) + paused;
}

std::string filter_line(const Json& s) {
  if (!has_number(s, "/particles")) return line("filter", "%s", "no scan yet");
  if (!has_number(s, "/fit")) {
    return line("filter", "%.0f particles, n_eff %.0f; no beam tells how well the scan fits", number(s, "/particles"),
                number(s, "/n_eff"));
  }
  return line("filter", "%.0f particles, n_eff %.0f, w_avg %.3f, %.0f %% of the beams fit", number(s, "/particles"),
              number(s, "/n_eff"), number(s, "/w_avg"), 100.0 * number(s, "/fit"));
}

/// Each with why it does not answer.
std::string ports_lines(const Json& s) {
  char battery[32] = "";
  if (number(s, "/battery_v") > 0.0) (void)std::snprintf(battery, sizeof battery, " (%.1f V)", number(s, "/battery_v"));
  std::string text =
      line("ports", "robot %s%s, laser %s", word(s, "/ports/robot").c_str(), battery, word(s, "/ports/laser").c_str());
  if (!has_object(s, "port_troubles")) return text;
  for (const auto& [port, why] : s["port_troubles"].items()) {
    if (why.is_string() && !why.get<std::string>().empty())
      text += std::string(13, ' ') + port + ": " + why.get<std::string>() + "\n";
  }
  return text;
}

}  // namespace

std::string status_table(const std::string& reply_line) {
  const Json reply = Json::parse(reply_line, nullptr, false);
  const Json s = reply.is_object() ? reply : Json::object();
  const bool is_past = has_pose(s) && word(s, "/ports/laser") == "down";
  std::string text = line("state", is_past ? "was %s: the laser is down" : "%s", word(s, "/state").c_str());
  text += pose_line(s);
  text += belief_lines(s);
  text += filter_line(s);
  text += map_line(s);
  text += gate_line(s);
  text += scans_line(s);
  text += wheels_lines(s);
  text += ports_lines(s);
  text += line("drive", "%s (switch: %s), stopped by: %s", word(s, "/drive").c_str(), word(s, "/drive_switch").c_str(),
               word(s, "/stopped_by").c_str());
  if (s.contains("may_drive_by_pose")) {
    const std::string forbidden_by = word(s, "/forbidden_by");
    text += s["may_drive_by_pose"] == true ? line("planners", "%s", "may drive by this pose")
                                           : line("planners", "must not drive by this pose: %s", forbidden_by.c_str());
  }
  if (const std::string why = word(s, "/never_driven"); why != "-" && !why.empty()) {
    text += line("not driven", "%s", why.c_str());
  }
  text += line("running", "%.0f s, log from %s on", number(s, "/since_start_s"), word(s, "/log_level").c_str());
  if (s.contains("recording") && s["recording"].is_object()) {
    text += line("recording", "%s, %.1f MB%s", word(s, "/recording/file").c_str(), number(s, "/recording/bytes") * 1e-6,
                 s.value("/recording/goes_on"_json_pointer, false) ? "" : ", is not being written");
  }
  return text + outputs_lines(s);
}

}  // namespace deltamap::tool
