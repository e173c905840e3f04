// SPDX-License-Identifier: Apache-2.0
// Who drives, and what the robot is told: the pilot, a hand or nobody, by what a person has said last, and never more
// than safety allows. Knows no port, no clock and no thread: whoever owns it says what has come and what time it is,
// and hands on what the robot's session answers. The io thread owns one; so does every virtual drive in tests.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/messages.hpp"
#include "daemon/control/command.hpp"
#include "daemon/kept/kept_drive.hpp"
#include "daemon/steps/pilot_step.hpp"
#include "daemon/telemetry/stop_log.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "drivers/pioneer/session.hpp"
#include "navigation/safety.hpp"

namespace deltamap::daemon {

/// How often DriveDesk::tick() is to be called: twice a controller cycle (protocols.md A6).
inline constexpr double kSafetyPeriodS = 0.05;

class DriveDesk {
 public:
  struct Wiring {
    drivers::pioneer::PioneerSession& session;
    KeptDrive& kept;  ///< what people have said, on disk
    Telemetry& telemetry;
    /// To the robot's port; what the answer holds comes back by observe() and obey_permission().
    std::function<void(drivers::pioneer::PioneerOutput)> obey;
    // A short line each; warn: something is degraded, or needs a person.
    std::function<void(const std::string&)> log;
    std::function<void(const std::string&)> warn;
  };
  /// `may_ever_drive`: by the settings. Where not, no velocity is ever sent.
  DriveDesk(bool may_ever_drive, const navigation::SafetyParams& safety, Wiring wiring);

  // --- what comes from the devices ---

  void observe(const Odometry& odometry, Timestamp now);
  void observe(const Scan& scan) { safety_.observe(scan); }
  /// After whatever the session was told or has heard: who may drive is its to say, for it hears the buttons.
  void obey_permission(Timestamp now);
  void set_nominal_scan_period(double period_s) { safety_.set_nominal_scan_period(period_s); }
  /// The robot's port is open, or is not: a session whose port is gone still holds what it knew.
  void set_port_open(bool is_open) { is_port_open_ = is_open; }
  [[nodiscard]] bool robot_is_connected() const { return is_port_open_ && wiring_.session.is_connected(); }

  // --- what people and the pilot say ---

  void take(const PilotWord& word, Timestamp now);
  struct Request {
    bool may_drive = false;
    std::uint64_t ticket = 0;
    Timestamp asked;
  };
  [[nodiscard]] control::CommandOutcome let_drive(const Request& request, Timestamp now);
  /// `who` is not 0.
  [[nodiscard]] control::CommandOutcome take_by_hand(std::uint64_t who, Timestamp asked, Timestamp now);
  /// A command counts for a moment from its own time on, however late it comes.
  void drive_by_hand(std::uint64_t who, const DriveCommand& command);
  void let_go(std::uint64_t who, Timestamp now);
  void set_safety(const navigation::SafetyParams& params) { safety_.set_params(params); }

  // --- what goes out ---

  /// Every kSafetyPeriodS.
  void tick(Timestamp now);
  [[nodiscard]] const navigation::AllowedMotion& allowed() const { return allowed_; }

 private:
  void keep_switch(Timestamp now);
  void send_allowed_motion(Timestamp now);
  void tell_what_is_forgotten();
  void tell_why_it_stands(navigation::StopReason unfit);
  void tell(const LogLine& line) const;
  void show(navigation::StopReason stop, const navigation::Motion& told);
  void put_in_hand_of(std::uint64_t who);
  [[nodiscard]] control::CommandOutcome switch_on(const Request& request, Timestamp now);
  [[nodiscard]] control::CommandOutcome switch_off(std::uint64_t ticket, Timestamp now);
  [[nodiscard]] std::string when_it_drives() const;

  Wiring wiring_;
  bool may_ever_drive_;
  navigation::Safety safety_;
  navigation::AllowedMotion allowed_;
  StopLog stop_log_;
  navigation::StopReason pose_stop_ = navigation::StopReason::kNone;  // of the newest scan
  bool creeps_ = false;                                               // as last told
  bool is_port_open_ = false;
  std::string blocked_around_;    // blocked zone that the robot stands in; empty: none
  std::uint64_t in_hand_of_ = 0;  // nobody else's commands are listened to; 0: in nobody's
  Timestamp hand_moved_{};        // of the newest command by hand
  Timestamp robot_heard_at_{};
};

}  // namespace deltamap::daemon
