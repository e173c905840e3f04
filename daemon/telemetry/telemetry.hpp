// SPDX-License-Identifier: Apache-2.0
// What the stages tell about themselves while they run: plain counters and last values, each written by one thread and
// read by any, without locks. The status line and, later, the dashboard read them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "core/messages.hpp"
#include "daemon/telemetry/notice.hpp"
#include "daemon/telemetry/output_board.hpp"
#include "daemon/telemetry/scan_counts.hpp"
#include "localization/motion/drive_calibration.hpp"
#include "mapping/gate/write_gate.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::daemon {

/// One value that one thread writes and others look at.
template <typename T>
class Gauge {
 public:
  Gauge() = default;
  explicit Gauge(T value) : value_{value} {}
  void set(T value) { value_.store(value, std::memory_order_relaxed); }
  /// By its only writer.
  void add(T amount) { set(value() + amount); }
  [[nodiscard]] T value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<T> value_{};
};

struct BeamCountGauges {
  Gauge<std::uint32_t> expected, fit, short_of, beyond;
  void set(const BeamCounts& counts);
  [[nodiscard]] BeamCounts value() const;
};

/// The newest estimate, value by value: a reader may find two scans mixed, which a person does not see.
struct EstimateGauges {
  Gauge<double> x_m, y_m, heading_rad, n_eff, w_avg;
  std::array<Gauge<double>, 6> covariance;  ///< xx xy xh yy yh hh
  Gauge<std::uint8_t> state;                ///< LocalizerState
  Gauge<std::uint32_t> particles, revision;
  Gauge<double> pose_right, map_wrong;
  Gauge<std::uint8_t> verdict;  ///< PoseVerdict
  BeamCountGauges stable, elsewhere;
  Gauge<double> other_share, other_x_m, other_y_m, other_heading_rad;
  void set(const Estimate& estimate);
};

/// What driving has told of wheels and mount, with deviations.
struct CalibrationGauges {
  Gauge<bool> known;
  std::array<Gauge<double>, 14> numbers;  ///< as localization::motion::numbers_of() orders them
  void set(const std::optional<localization::motion::DriveCalibration>& calibration);
  [[nodiscard]] std::optional<localization::motion::DriveCalibration> get() const;
};

struct GateGauges {
  /// mapping::gate::GateReason; before the first scan nobody knows where the robot is.
  Gauge<std::uint8_t> reason{static_cast<std::uint8_t>(mapping::gate::GateReason::kSearching)};
  std::array<Gauge<double>, mapping::gate::kGateReasons> times_s;
  void set(mapping::gate::GateReason now, const mapping::gate::GateTimes& times);
  [[nodiscard]] mapping::gate::GateTimes times() const;
};

struct Telemetry {
  // io thread
  Gauge<bool> robot_up, laser_up;
  Notice robot_trouble, laser_trouble;  ///< why the device does not answer; what was said last of it while it is down
  Gauge<bool> drives;                   ///< the pilot's commands are listened to
  Gauge<bool> by_hand;                  ///< a person's are, and the pilot's are not
  Notice never_driven;                  ///< why this robot is not driven, whatever a person says
  Gauge<std::uint8_t> drive_switch;     ///< drivers::pioneer::DriveSwitch: what a person said last
  Gauge<double> zone_limit_m_per_s;  ///< of the zones around the robot; 0 or infinite: none, or nobody knows the pose
  Gauge<double> told_speed_m_per_s, told_turn_rate_rad_per_s;  ///< what the robot was told last
  Gauge<double> battery_v;
  Gauge<std::uint8_t> stop_reason;       ///< navigation::StopReason
  Gauge<std::uint8_t> unfit;             ///< navigation::StopReason: what of robot and laser forbids to drive
  Gauge<std::uint32_t> times_let_drive;  ///< by a person: who remembers what the laser has missed begins anew
  Gauge<std::uint64_t> odometry, odometry_lost, scans, scans_lost, recording_lost;
  // recorder thread
  Gauge<std::uint64_t> recorded_bytes;
  Gauge<bool> records;  ///< false: never began, has ended, or pauses
  OutputBoard outputs;  ///< recorder and map thread
  // control thread
  Gauge<std::uint8_t> log_level;  ///< LogLevel
  // localization thread
  Gauge<std::uint64_t> localized, dropped, tracked_lost;
  EstimateGauges estimate;
  CalibrationGauges calibration;
  Gauge<double> fit;  ///< share of the newest scan's beams that the map explains; below 0: none tells
  Gauge<double> latency_s;
  Gauge<double> wanted_speed_m_per_s, wanted_turn_rate_rad_per_s;  ///< by the pilot; 0 where it wants to stand
  Gauge<std::uint8_t> pose_stop;                                   ///< navigation::StopReason: of the newest pose
  Gauge<bool> paused;                                              ///< by the operator: Δ-mapping sees no scans
  // delta thread
  Gauge<double> r_d;
  Gauge<bool> in_phase;
  Gauge<std::uint32_t> phase, stored_scans, phases_closed, sets_lost;
  Gauge<std::uint32_t> transients_standing, transients_gone;  ///< blocks of the transient layer
  GateGauges gate;
  // map thread
  Gauge<std::uint32_t> newest_revision, refused;
  Gauge<std::uint32_t> stale_refusals;  ///< of those refused: they leave the map stale
};

/// For planners, whoever drives: what of robot, laser or pose forbids to drive by the pose. Says nothing of motors, of
/// the STOP button, or of who drives.
[[nodiscard]] navigation::StopReason forbidden_by(const Telemetry& telemetry);
[[nodiscard]] inline bool may_drive_by_pose(const Telemetry& telemetry) {
  return forbidden_by(telemetry) == navigation::StopReason::kNone;
}

/// What the write gate is like; nothing: no scan votes, since mapping is off or paused.
[[nodiscard]] std::optional<mapping::gate::GateReason> gate_now(const Telemetry& telemetry, bool mapping_enabled);

/// Nothing while the robot is down, or has told none.
[[nodiscard]] std::optional<double> told_battery_v(const Telemetry& telemetry);

[[nodiscard]] ScanCounts counts_of(const Telemetry& telemetry);

/// One line for a person: devices, state, verdict and pose, N_eff, w_avg, revision, Δ-phase, drops, latency; before the
/// first scan nothing of what only a scan tells.
[[nodiscard]] std::string status_line(const Telemetry& telemetry);

[[nodiscard]] std::string_view name_of(LocalizerState state);
[[nodiscard]] std::string_view name_of(PoseVerdict verdict);

}  // namespace deltamap::daemon
