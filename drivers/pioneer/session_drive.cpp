// SPDX-License-Identifier: Apache-2.0
// What the connected robot is told: limits, motors, set points; and what its buttons say about the motors.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/geometry/angle.hpp"
#include "drivers/pioneer/session.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr int kMaxRequests = 5;                    // of one state, before we take the robot as it is
constexpr Duration kEchoOfEnable{1'000'000'000};   // a command, a SIP cycle and both on the line, with room for a queue
constexpr Duration kEmergencyRepeat{100'000'000};  // a SIP cycle: the next one shows whether the robot stands
constexpr Duration kEchoOfDisable{500'000'000};

std::string limits_line(const char* what, const StoppingLimits& limits) {
  char watchdog[32] = "unknown";
  if (limits.watchdog_s) (void)std::snprintf(watchdog, sizeof watchdog, "%.1f s", *limits.watchdog_s);
  char text[160];
  (void)std::snprintf(text, sizeof text, "robot %s: deceleration=%.2f m/s^2 turn_deceleration=%.0f deg/s^2 watchdog=%s",
                      what, limits.deceleration_m_per_s2, degrees(limits.turn_deceleration_rad_per_s2), watchdog);
  return text;
}

}  // namespace

bool PioneerSession::stop_button_is_pressed() const {
  return is_connected() && newest_sip_ && newest_sip_->has(sip_flag::kStopped);
}

void PioneerSession::watch_motors(Timestamp sip_began, Timestamp now, PioneerOutput& out) {
  using From = MotorReport::From;
  if (state_ == State::kIdle) return;
  const auto lately = [now](const std::optional<Timestamp>& sent, Duration echo) { return sent && now - *sent < echo; };
  // A SIP that was under way when CLOSE or ENABLE 0 went out shows what was before them.
  const bool is_after_disable = disable_sent_ && sip_began >= *disable_sent_;
  const bool searches = state_ == State::kQuieting || state_ == State::kObserving || state_ == State::kClosing ||
                        state_ == State::kSyncing;
  const DriveSwitch before = permission_.drive_switch();
  permission_.observe({.motors_on = newest_sip_->has(sip_flag::kMotorsEnabled),
                       .stop_button = newest_sip_->has(sip_flag::kStopped),
                       .from = searches                    ? From::kLeftOver
                               : state_ == State::kOpening ? From::kOpening
                                                           : From::kConnection,
                       .may_be_our_enable = lately(enable_sent_, kEchoOfEnable),
                       .may_be_our_disable = is_after_disable && lately(disable_sent_, kEchoOfDisable)});
  if (permission_.drive_switch() != before) {
    out.output.log.push_back(
        permission_.holds()
            ? "robot may drive: the MOTORS button was pressed"
            : "robot motors were switched off at the robot: press MOTORS, or `deltamap ctl drive wander`");
  }
  if (permission_.holds()) return;
  queue_.drop(CommandNumber::kEnable);
  if (set_point_ && (set_point_->speed_m_per_s != 0.0 || set_point_->turn_rate_rad_per_s != 0.0)) {
    set_point_ = DriveCommand{now, 0.0, 0.0};
    push_set_points();
  }
  if (permission_.must_disable()) next_check_ = now;
}

PioneerOutput PioneerSession::switch_drive(bool on, Timestamp now) {
  PioneerOutput out;
  permission_.operator_switches(on);
  if (!on) {
    queue_.drop(CommandNumber::kEnable);
    return stop_driving(now);
  }
  enable_was_sent_ = false;
  next_check_ = now;
  return finished(now, std::move(out));
}

/// Commands are never acknowledged: they are repeated until SIPs and CONFIGpac show their effect (A1).
void PioneerSession::bring_robot_to_wanted_state(Timestamp now, PioneerOutput& out) {
  bring_limits(out);
  if (!newest_sip_) return;
  const bool sonar_is_on = newest_sip_->has(sip_flag::kSonarArrays);
  if (sonar_is_on != params_.sonar && sonar_requests_ < kMaxRequests) {
    ++sonar_requests_;
    queue_.push({CommandNumber::kSonar, params_.sonar ? 1 : 0});
  }
  bring_motors(now, out);
}

void PioneerSession::bring_limits(PioneerOutput& out) {
  if (limits_are_told_) return;
  const bool is_shown = config_ && shows(*config_, params_.limits);
  if (!is_shown && limit_requests_ < kMaxRequests) {
    ++limit_requests_;
    for (const Command& command : limit_commands(params_.limits)) queue_.push(command);
    queue_.push({CommandNumber::kConfig, 1});
    return;
  }
  limits_are_told_ = true;
  const char* what = is_shown  ? "keeps to its limits"
                     : config_ ? "does not take its limits, it has its own"
                               : "does not tell its limits, they are taken for";
  out.output.log.push_back(limits_line(what, stopping_limits()));
  if (!knows_watchdog()) out.output.log.push_back("robot does not tell its watchdog: it is not driven");
}

std::string_view PioneerSession::why_never_driven() const {
  if (!units_.why_never_driven().empty()) return units_.why_never_driven();
  if (limits_are_told_ && !knows_watchdog()) return "the robot does not tell its watchdog";
  if (knows_watchdog() && config_->watchdog_ms == 0)
    return "the robot's watchdog is off: it would never stop by itself";
  return {};
}

/// ENABLE 1 waits for the watchdog, without which nobody knows how the robot would stop, and for a robot of known units
/// and hull. It is sent once, not until it shows: motors that are off in the next SIP may have been switched off again
/// by a person who was faster than the SIP.
void PioneerSession::bring_motors(Timestamp now, PioneerOutput& out) {
  const bool motors_are_on = newest_sip_->has(sip_flag::kMotorsEnabled);
  if (permission_.must_disable() && motors_are_on && disable_requests_ < kMaxRequests) {
    ++disable_requests_;
    queue_.push({CommandNumber::kEnable, 0});
  }
  if (!motors_are_on && enable_was_sent_ && permission_.holds() && now - *enable_sent_ >= kEchoOfEnable) {
    permission_.enable_had_no_effect();
    out.output.log.push_back("robot motors did not come on: press MOTORS, or `deltamap ctl drive wander`");
  }
  const bool is_due = permission_.holds() && may_be_driven() && !enable_was_sent_;
  if (motors_are_on || !is_due || stop_button_is_pressed()) return;
  queue_.drop(CommandNumber::kEnable);
  queue_.push({CommandNumber::kEnable, 1});
}

PioneerOutput PioneerSession::drive(const DriveCommand& command, Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ != State::kConnected) return finished(now, std::move(out));
  const bool may_drive = permission_.holds() && may_be_driven();
  DriveCommand wanted = may_drive ? command : DriveCommand{command.time, 0.0, 0.0};
  const MotionLimits& limits = params_.limits;
  wanted.speed_m_per_s = std::clamp(wanted.speed_m_per_s, -limits.max_speed_m_per_s, limits.max_speed_m_per_s);
  wanted.turn_rate_rad_per_s =
      std::clamp(wanted.turn_rate_rad_per_s, -limits.max_turn_rate_rad_per_s, limits.max_turn_rate_rad_per_s);
  const bool is_number = std::isfinite(wanted.speed_m_per_s) && std::isfinite(wanted.turn_rate_rad_per_s);
  if (!is_number) return stop_driving(now);
  const bool is_to_stand = wanted.speed_m_per_s == 0.0 && wanted.turn_rate_rad_per_s == 0.0;
  if (emergency_stop_ && is_to_stand) return emergency_stop(now);  // VEL 0 would withdraw it
  emergency_stop_.reset();
  const bool is_new = !set_point_ || set_point_->speed_m_per_s != wanted.speed_m_per_s ||
                      set_point_->turn_rate_rad_per_s != wanted.turn_rate_rad_per_s;
  set_point_ = wanted;
  if (is_new) {
    push_set_points();
    next_pulse_ = now + pulse_interval();
  }
  return finished(now, std::move(out));
}

PioneerOutput PioneerSession::emergency_stop(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ != State::kConnected) return finished(now, std::move(out));
  const bool moves = newest_sip_ && (newest_sip_->left_mm_per_s != 0 || newest_sip_->right_mm_per_s != 0);
  const bool is_due = !emergency_stop_ || (moves && now - *emergency_stop_ >= kEmergencyRepeat);
  if (is_due) push_emergency_stop(now);
  return finished(now, std::move(out));
}

void PioneerSession::push_emergency_stop(Timestamp now) {
  set_point_.reset();
  queue_.drop(CommandNumber::kVel);
  queue_.drop(CommandNumber::kRvel);
  queue_.drop(CommandNumber::kEstop);
  queue_.push_first({CommandNumber::kEstop, {}});
  emergency_stop_ = now;
  next_pulse_ = now + pulse_interval();
}

PioneerOutput PioneerSession::stop_driving(Timestamp now) {
  PioneerOutput out;
  if (mode_ == SessionMode::kListenOnly || state_ == State::kIdle) return out;
  if (set_point_ && (state_ == State::kConnected || state_ == State::kSwitching)) {
    set_point_ = DriveCommand{now, 0.0, 0.0};
    push_set_points();
    set_point_.reset();
  }
  return finished(now, std::move(out));
}

void PioneerSession::push_set_points() {
  const double speed = set_point_ ? set_point_->speed_m_per_s : 0.0;
  const double turn_rate = set_point_ ? set_point_->turn_rate_rad_per_s : 0.0;
  queue_.drop(CommandNumber::kVel);
  queue_.drop(CommandNumber::kRvel);
  queue_.push_first({CommandNumber::kRvel, whole_degrees(turn_rate)});
  queue_.push_first({CommandNumber::kVel, whole_mm(speed)});
}

}  // namespace deltamap::drivers::pioneer
