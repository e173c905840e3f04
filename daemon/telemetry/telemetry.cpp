// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/telemetry.hpp"

#include <cinttypes>
#include <cstdio>

#include "core/geometry/angle.hpp"

namespace deltamap::daemon {
namespace {

const char* up(const Gauge<bool>& device) { return device.value() ? "up" : "--"; }

const char* phase_mark(const Telemetry& t) { return t.paused.value() ? "-" : t.in_phase.value() ? "*" : ""; }

std::string estimate_words(const EstimateGauges& e) {
  const auto state = name_of(static_cast<LocalizerState>(e.state.value()));
  const auto verdict = name_of(static_cast<PoseVerdict>(e.verdict.value()));
  char words[224];
  (void)std::snprintf(
      words, sizeof words, "%.*s pose=%.*s x=%.2f y=%.2f heading=%.0f n_eff=%.0f/%" PRIu32 " w_avg=%.3f",
      static_cast<int>(state.size()), state.data(), static_cast<int>(verdict.size()), verdict.data(), e.x_m.value(),
      e.y_m.value(), degrees(e.heading_rad.value()), e.n_eff.value(), e.particles.value(), e.w_avg.value());
  return words;
}

}  // namespace

std::string_view name_of(LocalizerState state) {
  switch (state) {
    case LocalizerState::kGlobal:
      return "global";
    case LocalizerState::kTracking:
      return "tracking";
    case LocalizerState::kLost:
      return "lost";
  }
  return "";
}

std::string_view name_of(PoseVerdict verdict) {
  switch (verdict) {
    case PoseVerdict::kUndecided:
      return "undecided";
    case PoseVerdict::kRight:
      return "right";
    case PoseVerdict::kWrong:
      return "wrong";
  }
  return "";
}

navigation::StopReason forbidden_by(const Telemetry& telemetry) {
  using navigation::StopReason;
  const auto unfit = static_cast<StopReason>(telemetry.unfit.value());
  if (unfit != StopReason::kNone) return unfit;
  return telemetry.localized.value() > 0 ? static_cast<StopReason>(telemetry.pose_stop.value())
                                         : StopReason::kPoseUnknown;
}

std::optional<mapping::gate::GateReason> gate_now(const Telemetry& telemetry, bool mapping_enabled) {
  if (!mapping_enabled || telemetry.paused.value()) return std::nullopt;
  return static_cast<mapping::gate::GateReason>(telemetry.gate.reason.value());
}

void BeamCountGauges::set(const BeamCounts& counts) {
  expected.set(counts.expected);
  fit.set(counts.fit);
  short_of.set(counts.short_of);
  beyond.set(counts.beyond);
}

BeamCounts BeamCountGauges::value() const {
  return {.expected = expected.value(), .fit = fit.value(), .short_of = short_of.value(), .beyond = beyond.value()};
}

void EstimateGauges::set(const Estimate& estimate) {
  x_m.set(estimate.map_from_robot.x);
  y_m.set(estimate.map_from_robot.y);
  heading_rad.set(estimate.map_from_robot.theta);
  n_eff.set(estimate.n_eff);
  w_avg.set(estimate.w_avg);
  std::size_t next = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) covariance[next++].set(estimate.covariance(row, column));
  }
  state.set(static_cast<std::uint8_t>(estimate.state));
  particles.set(estimate.particles);
  revision.set(estimate.revision);
  const Belief& belief = estimate.belief;
  pose_right.set(belief.pose_right);
  map_wrong.set(belief.map_wrong);
  verdict.set(static_cast<std::uint8_t>(belief.verdict));
  stable.set(belief.stable);
  elsewhere.set(belief.elsewhere);
  other_share.set(belief.other_share);
  other_x_m.set(belief.map_from_other.x);
  other_y_m.set(belief.map_from_other.y);
  other_heading_rad.set(belief.map_from_other.theta);
}

void CalibrationGauges::set(const std::optional<localization::motion::DriveCalibration>& calibration) {
  known.set(calibration.has_value());
  if (!calibration) return;
  const std::array<double, 14> found = numbers_of(*calibration);
  for (std::size_t i = 0; i < found.size(); ++i) numbers[i].set(found[i]);
}

std::optional<localization::motion::DriveCalibration> CalibrationGauges::get() const {
  std::array<double, 14> found{};
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = numbers[i].value();
  return known.value() ? localization::motion::calibration_of(found) : std::nullopt;
}

void GateGauges::set(mapping::gate::GateReason now, const mapping::gate::GateTimes& times) {
  reason.set(static_cast<std::uint8_t>(now));
  for (std::size_t i = 0; i < times.size(); ++i) times_s[i].set(times[i]);
}

mapping::gate::GateTimes GateGauges::times() const {
  mapping::gate::GateTimes times{};
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = times_s[i].value();
  return times;
}

std::optional<double> told_battery_v(const Telemetry& telemetry) {
  const double battery_v = telemetry.battery_v.value();
  return telemetry.robot_up.value() && battery_v > 0.0 ? std::optional{battery_v} : std::nullopt;
}

ScanCounts counts_of(const Telemetry& t) {
  return {.decoded = t.scans.value(),
          .localized = t.localized.value(),
          .dropped = t.dropped.value(),
          .lost = t.scans_lost.value(),
          .odometry = t.odometry.value(),
          .odometry_lost = t.odometry_lost.value(),
          .tracked_lost = t.tracked_lost.value(),
          .sets_lost = t.sets_lost.value(),
          .recording_lost = t.recording_lost.value()};
}

std::string status_line(const Telemetry& t) {
  std::uint64_t drops = 0;
  for (const auto& [name, count] : drops_of(counts_of(t))) drops += count;
  const bool is_known = t.localized.value() > 0;
  const std::uint32_t revision = is_known ? t.estimate.revision.value() : t.newest_revision.value();
  char line[160];
  (void)std::snprintf(line, sizeof line, "robot=%s laser=%s scans=%" PRIu64 " ", up(t.robot_up), up(t.laser_up),
                      t.scans.value());
  std::string text = line + (is_known ? estimate_words(t.estimate) : "no scan yet");
  (void)std::snprintf(line, sizeof line, " map=%" PRIu32 " refused=%" PRIu32 " phase=%" PRIu32 "%s drops=%" PRIu64,
                      revision, t.refused.value(), t.phase.value(), phase_mark(t), drops);
  text += line;
  if (!is_known) return text;
  (void)std::snprintf(line, sizeof line, " latency_ms=%.1f", t.latency_s.value() * 1e3);
  return text + line;
}

}  // namespace deltamap::daemon
