// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/metrics_text.hpp"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include "daemon/system/used_memory.hpp"
#include "daemon/telemetry/stage.hpp"
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {
namespace {

class Text {
 public:
  void counter(std::string_view name, std::string_view help, double value) {
    head(name, help, "counter");
    row(name, "", value);
  }
  void gauge(std::string_view name, std::string_view help, double value) {
    head(name, help, "gauge");
    row(name, "", value);
  }
  void head(std::string_view name, std::string_view help, std::string_view type) {
    text_.append("# HELP deltamap_").append(name).append(" ").append(help).append("\n");
    text_.append("# TYPE deltamap_").append(name).append(" ").append(type).append("\n");
  }
  /// `labels`: empty, or {key="value"}.
  void row(std::string_view name, const std::string& labels, double value) {
    char number[40];
    (void)std::snprintf(number, sizeof number, " %.15g\n", value);
    text_.append("deltamap_").append(name).append(labels).append(number);
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// No name in the daemon has a character that needs to be escaped.
std::string label(std::string_view key, std::string_view value) {
  return "{" + std::string(key) + "=\"" + std::string(value) + "\"}";
}

double counted(const Gauge<std::uint64_t>& gauge) { return static_cast<double>(gauge.value()); }

void add_scans(Text& text, const Telemetry& t) {
  text.counter("scans_total", "Scans that were decoded.", counted(t.scans));
  text.counter("scans_localized_total", "Scans that were localized.", counted(t.localized));
  text.counter("odometry_packets_total", "Odometry packets that were decoded.", counted(t.odometry));
  text.head("dropped_total", "Items that found a full queue or were overtaken, by kind.", "counter");
  const std::pair<const char*, const Gauge<std::uint64_t>*> drops[] = {{"scan_overtaken", &t.dropped},
                                                                       {"scan_lost", &t.scans_lost},
                                                                       {"odometry_lost", &t.odometry_lost},
                                                                       {"tracked_lost", &t.tracked_lost},
                                                                       {"recording_lost", &t.recording_lost}};
  for (const auto& [kind, count] : drops) text.row("dropped_total", label("kind", kind), counted(*count));
  if (t.localized.value() > 0)
    text.gauge("latency_seconds", "From the newest scan's last byte to its pose.", t.latency_s.value());
}

void add_estimate(Text& text, const EstimateGauges& e) {
  text.head("state", "1 for the localizer's present state.", "gauge");
  for (const auto state : {LocalizerState::kGlobal, LocalizerState::kTracking, LocalizerState::kLost}) {
    text.row("state", label("state", name_of(state)), static_cast<std::uint8_t>(state) == e.state.value() ? 1.0 : 0.0);
  }
  text.gauge("pose_x_meters", "Position in the map.", e.x_m.value());
  text.gauge("pose_y_meters", "Position in the map.", e.y_m.value());
  text.gauge("pose_heading_radians", "Heading in the map, counter-clockwise.", e.heading_rad.value());
  text.gauge("pose_right_ratio", "P(pose right).", e.pose_right.value());
  text.gauge("map_wrong_ratio", "P(map wrong) of what is in view.", e.map_wrong.value());
  text.gauge("particles", "Particles of the filter.", e.particles.value());
  text.gauge("effective_sample_size", "N_eff before resampling.", e.n_eff.value());
}

void add_map(Text& text, const Telemetry& t) {
  text.gauge("map_revision", "Number k of the newest map M_k.", t.newest_revision.value());
  text.counter("changes_refused_total", "Changes of the map that were refused.", t.refused.value());
  text.gauge("divergence_ratio", "r_d of the newest scan.", t.r_d.value());
  text.gauge("stored_scans", "Scans that the running phase has stored.", t.stored_scans.value());
  text.gauge("mapping_paused", "1 while an operator has paused mapping.", t.paused.value() ? 1.0 : 0.0);
  const bool is_open = t.laser_up.value() && gate_now(t, true) == mapping::gate::GateReason::kOpen;
  text.gauge("gate_open", "1 while the map may be written.", is_open ? 1.0 : 0.0);
  text.head("gate_seconds_total", "Time of the write gate, by what held it closed (open: nothing).", "counter");
  const mapping::gate::GateTimes times = t.gate.times();
  for (std::size_t i = 0; i < times.size(); ++i) {
    text.row("gate_seconds_total", label("reason", name_of(static_cast<mapping::gate::GateReason>(i))), times[i]);
  }
  text.head("temporary_blocks", "Blocks that differ from the map for now, by kind.", "gauge");
  text.row("temporary_blocks", label("kind", "standing"), t.transients_standing.value());
  text.row("temporary_blocks", label("kind", "gone"), t.transients_gone.value());
}

void add_machine(Text& text, const Telemetry& t, double since_start_s) {
  text.head("port_up", "1 while the device on the port answers.", "gauge");
  text.row("port_up", label("port", "robot"), t.robot_up.value() ? 1.0 : 0.0);
  text.row("port_up", label("port", "laser"), t.laser_up.value() ? 1.0 : 0.0);
  if (const auto battery_v = told_battery_v(t)) text.gauge("battery_volts", "Of the robot.", *battery_v);
  text.gauge("resident_bytes", "Resident memory of the daemon.", static_cast<double>(resident_bytes()));
  text.counter("cpu_seconds_total", "Processor time of the daemon.", process_cpu_s());
  text.gauge("uptime_seconds", "Since the daemon's start.", since_start_s);
  text.head("build_info", "1; the version is in the label.", "gauge");
  text.row("build_info", label("version", version()), 1.0);
}

}  // namespace

std::string metrics_text(const Telemetry& telemetry, double since_start_s) {
  Text text;
  add_scans(text, telemetry);
  const bool is_known = telemetry.localized.value() > 0;
  if (is_known) add_estimate(text, telemetry.estimate);
  if (is_known && telemetry.fit.value() >= 0.0)  // else it is an older scan's
    text.gauge("scan_weight_ratio", "w_avg of the newest scan.", telemetry.estimate.w_avg.value());
  add_map(text, telemetry);
  add_machine(text, telemetry, since_start_s);
  return text.take();
}

}  // namespace deltamap::daemon
