// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/wanted_state.hpp"

#include <cstdio>

#include "core/geometry/angle.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr Duration kCheckInterval{1'000'000'000};
constexpr int kMaxRequests = 5;                   // of one state, before we take the robot as it is
constexpr Duration kEchoOfEnable{1'000'000'000};  // a command, a SIP cycle and both on the line, with room for a queue
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

void WantedState::begin_connection(Transmitter& line) {
  if (is_to_drive_ && !permission_.holds()) {
    const bool by_operator = permission_.drive_switch() == DriveSwitch::kOffByOperator;
    line.log("robot stands: driving is " + std::string(name_of(permission_.drive_switch())) + ": " +
             (by_operator ? "" : "press MOTORS, or ") + "`deltamap ctl drive wander`");
  }
  next_check_ = line.now();
  limit_requests_ = 0;
  sonar_requests_ = 0;
  disable_requests_ = 0;
  limits_are_told_ = false;
  enable_was_sent_ = false;
}

void WantedState::watch_motors(Timestamp sip_began, MotorReport::From from, Transmitter& line) {
  const Sip& sip = *line.receiver().newest_sip();
  const auto lately = [now = line.now()](const std::optional<Timestamp>& sent, Duration echo) {
    return sent && now - *sent < echo;
  };
  // A SIP that was under way when CLOSE or ENABLE 0 went out shows what was before them.
  const bool is_after_disable = disable_sent_ && sip_began >= *disable_sent_;
  const DriveSwitch before = permission_.drive_switch();
  permission_.observe({.motors_on = sip.has(sip_flag::kMotorsEnabled),
                       .stop_button = sip.has(sip_flag::kStopped),
                       .from = from,
                       .may_be_our_enable = lately(enable_sent_, kEchoOfEnable),
                       .may_be_our_disable = is_after_disable && lately(disable_sent_, kEchoOfDisable)});
  if (permission_.drive_switch() != before) {
    line.log(permission_.holds()
                 ? "robot may drive: the MOTORS button was pressed"
                 : "robot motors were switched off at the robot: press MOTORS, or `deltamap ctl drive wander`");
  }
  if (permission_.holds()) return;
  line.commands().drop(CommandNumber::kEnable);
  if (permission_.must_disable()) next_check_ = line.now();
}

void WantedState::operator_switches(bool on, Transmitter& line) {
  permission_.operator_switches(on);
  if (!on) return line.commands().drop(CommandNumber::kEnable);
  enable_was_sent_ = false;
  next_check_ = line.now();
}

void WantedState::note_sent(const Command& command, Timestamp now) {
  if (command == Command{CommandNumber::kEnable, 1}) {
    enable_sent_ = now;
    enable_was_sent_ = true;
    permission_.enable_is_sent();
  }
  if (command == Command{CommandNumber::kEnable, 0} || command.number == CommandNumber::kClose) disable_sent_ = now;
}

void WantedState::bring(Transmitter& line) {
  next_check_ = line.now() + kCheckInterval;
  bring_limits(line);
  if (!line.receiver().newest_sip()) return;
  bring_sonar(line);
  bring_motors(line);
}

void WantedState::bring_limits(Transmitter& line) {
  if (limits_are_told_) return;
  const Receiver& robot = line.receiver();
  const bool is_shown = robot.config() && shows(*robot.config(), limits_);
  if (!is_shown && limit_requests_ < kMaxRequests) {
    ++limit_requests_;
    for (const Command& command : limit_commands(limits_)) line.commands().push(command);
    line.commands().push({CommandNumber::kConfig, 1});
    return;
  }
  limits_are_told_ = true;
  const char* what = is_shown         ? "keeps to its limits"
                     : robot.config() ? "does not take its limits, it has its own"
                                      : "does not tell its limits, they are taken for";
  line.log(limits_line(what, robot.stopping_limits()));
  if (!robot.knows_watchdog()) line.log("robot does not tell its watchdog: it is not driven");
}

void WantedState::bring_sonar(Transmitter& line) {
  const bool is_on = line.receiver().newest_sip()->has(sip_flag::kSonarArrays);
  if (is_on == sonar_ || sonar_requests_ >= kMaxRequests) return;
  ++sonar_requests_;
  line.commands().push({CommandNumber::kSonar, sonar_ ? 1 : 0});
}

/// ENABLE 1 waits until the robot may be driven. It is sent once, not until it shows: motors that are off in the next
/// SIP may have been switched off again by a person who was faster than the SIP.
void WantedState::bring_motors(Transmitter& line) {
  const Sip& sip = *line.receiver().newest_sip();
  const bool motors_are_on = sip.has(sip_flag::kMotorsEnabled);
  if (permission_.must_disable() && motors_are_on && disable_requests_ < kMaxRequests) {
    ++disable_requests_;
    line.commands().push({CommandNumber::kEnable, 0});
  }
  if (!motors_are_on && enable_was_sent_ && permission_.holds() && line.now() - *enable_sent_ >= kEchoOfEnable) {
    permission_.enable_had_no_effect();
    line.log("robot motors did not come on: press MOTORS, or `deltamap ctl drive wander`");
  }
  const bool is_due = permission_.holds() && may_be_driven(line.receiver()) && !enable_was_sent_;
  if (motors_are_on || !is_due || sip.has(sip_flag::kStopped)) return;
  line.commands().drop(CommandNumber::kEnable);
  line.commands().push({CommandNumber::kEnable, 1});
}

bool WantedState::may_be_driven(const Receiver& robot) const {
  return robot.knows_watchdog() && robot.why_never_driven().empty();
}

std::string_view WantedState::why_never_driven(const Receiver& robot) const {
  if (!robot.why_never_driven().empty()) return robot.why_never_driven();
  if (limits_are_told_ && !robot.knows_watchdog()) return "the robot does not tell its watchdog";
  if (robot.knows_watchdog() && robot.config()->watchdog_ms == 0)
    return "the robot's watchdog is off: it would never stop by itself";
  return {};
}

}  // namespace deltamap::drivers::pioneer
