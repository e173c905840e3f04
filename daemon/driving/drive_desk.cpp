// SPDX-License-Identifier: Apache-2.0
#include "daemon/driving/drive_desk.hpp"

#include <chrono>
#include <utility>

namespace deltamap::daemon {
namespace {

constexpr std::chrono::seconds kRequestLife{1};  // an older request to drive has waited in a hung thread
constexpr double kHandLifeS = 0.25;              // of a command by hand; ends within 0.3 s, a safety period later
constexpr std::chrono::milliseconds kRobotSilence{500};  // five controller cycles; a silent robot may not hear us

const std::string kNeverDrives = "'navigation.mode' is off: this daemon never drives (set it to wander, and restart)";

}  // namespace

DriveDesk::DriveDesk(bool may_ever_drive, const navigation::SafetyParams& safety, Wiring wiring)
    : wiring_{std::move(wiring)}, may_ever_drive_{may_ever_drive}, safety_{safety} {
  if (may_ever_drive_ && !wiring_.kept.why_unknown().empty()) wiring_.warn(wiring_.kept.why_unknown());
  show(navigation::StopReason::kNoCommand, {});
}

// --- what comes from the devices ---

void DriveDesk::observe(const Odometry& odometry, Timestamp now) {
  robot_heard_at_ = now;
  safety_.observe(odometry);
  wiring_.telemetry.battery_v.set(odometry.battery_v);
}

void DriveDesk::obey_permission(Timestamp now) {
  const drivers::pioneer::DrivePermission& permission = wiring_.session.permission();
  if (!permission.holds()) safety_.release();
  wiring_.telemetry.drives.set(permission.holds());
  wiring_.telemetry.drive_switch.set(static_cast<std::uint8_t>(permission.drive_switch()));
  wiring_.telemetry.never_driven.set(wiring_.session.why_never_driven());
  safety_.set_unknown_robot(wiring_.session.is_unknown_robot());
  keep_switch(now);
}

void DriveDesk::keep_switch(Timestamp now) {
  const auto value = in_hand_of_ != 0
                         ? drivers::pioneer::DriveSwitch::kOffByOperator
                         : switch_to_keep(wiring_.session.permission().drive_switch(), safety_.ends_by_word());
  const std::string line = wiring_.kept.keep(value, now);
  if (!line.empty()) (wiring_.kept.why_not_kept().empty() ? wiring_.log : wiring_.warn)(line);
}

// --- what goes out ---

void DriveDesk::tick(Timestamp now) {
  tell_what_is_forgotten();
  keep_switch(now);  // the laser may have stopped the robot, or the last write to disk may have failed
  send_allowed_motion(now);
}

void DriveDesk::send_allowed_motion(Timestamp now) {
  const drivers::pioneer::PioneerSession& session = wiring_.session;
  const navigation::StopReason unfit = safety_.unfit(now);
  wiring_.telemetry.unfit.set(static_cast<std::uint8_t>(unfit));
  if (!robot_is_connected()) {
    safety_.told(std::nullopt, now);
    allowed_ = {.stop = safety_.allowed(now).stop};
    show(allowed_.stop, {});
    return tell(stop_log_.line_for_planners(unfit, pose_stop_));
  }
  if (in_hand_of_ != 0 && seconds(now - hand_moved_) > kHandLifeS) safety_.release();
  const auto limits = session.stopping_limits();
  safety_.set_stopping_behaviour(
      {limits.watchdog_s, limits.deceleration_m_per_s2, limits.turn_deceleration_rad_per_s2});
  allowed_ = safety_.allowed(now);
  const navigation::Motion told{allowed_.speed_m_per_s, allowed_.turn_rate_rad_per_s};
  show(allowed_.stop, told);
  tell_why_it_stands(unfit);
  if (!may_ever_drive_) return;
  if (told.speed_m_per_s > 0.0 && std::exchange(creeps_, safety_.creeps()) != safety_.creeps()) {
    wiring_.log(creeps_ ? "driving slowly until the scans have followed the wheels"
                        : "driving at full speed: the scans follow the wheels, or had nothing to show it by");
  }
  safety_.told(told, now);
  if (allowed_.brake_hard) return wiring_.obey(wiring_.session.emergency_stop(now));
  wiring_.obey(wiring_.session.drive({now, told.speed_m_per_s, told.turn_rate_rad_per_s}, now));
}

/// A person may have said so here, or by the MOTORS button.
void DriveDesk::tell_what_is_forgotten() {
  if (wiring_.telemetry.times_let_drive.value() == safety_.times_let_drive()) return;
  wiring_.telemetry.times_let_drive.set(safety_.times_let_drive());
  if (safety_.has_forgotten_blindness())
    wiring_.log("a person said drive: what the laser has ceased to see is held against it no more");
}

void DriveDesk::tell_why_it_stands(navigation::StopReason unfit) {
  const LogLine own = may_ever_drive_ ? stop_log_.line(allowed_.stop) : LogLine{};
  const LogLine of_planners = stop_log_.line_for_planners(unfit, pose_stop_);
  tell(own);
  if (own.text.empty() || !stop_log_.says_it_all()) tell(of_planners);
}

void DriveDesk::tell(const LogLine& line) const {
  if (!line.text.empty()) (line.is_warning ? wiring_.warn : wiring_.log)(line.text);
}

void DriveDesk::show(navigation::StopReason stop, const navigation::Motion& told) {
  wiring_.telemetry.stop_reason.set(static_cast<std::uint8_t>(stop));
  wiring_.telemetry.told_speed_m_per_s.set(told.speed_m_per_s);
  wiring_.telemetry.told_turn_rate_rad_per_s.set(told.turn_rate_rad_per_s);
}

// --- the pilot ---

void DriveDesk::take(const PilotWord& word, Timestamp now) {
  pose_stop_ = word.pose;
  safety_.set_wheels_spin(word.wheels_spin);
  safety_.set_misses_walls(word.misses_walls);
  if (!word.zones.blocked_around.empty() && std::exchange(blocked_around_, word.zones.blocked_around).empty()) {
    wiring_.warn("the robot stands in blocked zone '" + word.zones.blocked_around +
                 "', which is not heeded until it has left: it drives slowly, drive it out");
  }
  if (word.zones.bind) blocked_around_ = word.zones.blocked_around;
  safety_.heed(word.zones);
  wiring_.telemetry.zone_limit_m_per_s.set(word.zones.most_speed_m_per_s);
  safety_.expect_no_range(word.expects_no_range ? std::optional{word.command.time} : std::nullopt);
  if (in_hand_of_ != 0 || !wiring_.session.permission().holds()) return;
  safety_.command(word.command, now, word.held_by);
}

// --- a person at the switch ---

control::CommandOutcome DriveDesk::let_drive(const Request& request, Timestamp now) {
  if (request.may_drive && in_hand_of_ != 0)
    return {request.ticket, false, "it is driven by hand: that must end first"};
  if (!request.may_drive) put_in_hand_of(0);
  return request.may_drive ? switch_on(request, now) : switch_off(request.ticket, now);
}

/// Refused as long as anything speaks against it: a refusal must not drive later, by itself. Where this daemon never
/// drives, the word still ends what waits for a person, for planners: STOP and `drive off` must not do that.
control::CommandOutcome DriveDesk::switch_on(const Request& request, Timestamp now) {
  const navigation::StopReason waited_for = safety_.ends_by_word();
  if (!may_ever_drive_ && waited_for == navigation::StopReason::kNone) return {request.ticket, false, kNeverDrives};
  if (now - request.asked > kRequestLife) {
    return {request.ticket, false, "it was asked for too long ago: say so again"};
  }
  if (wiring_.session.stop_button_is_pressed()) {
    return {request.ticket, false, "the STOP button is pressed: let it go first"};
  }
  safety_.let_drive_again();
  const navigation::StopReason held_by = may_ever_drive_ ? safety_.waits_for() : safety_.ends_by_word();
  if (held_by != navigation::StopReason::kNone) {
    return {request.ticket, false, "it stands: " + std::string(name_of(held_by)) + "; say so again when that is over"};
  }
  if (!may_ever_drive_) {
    return {request.ticket, true, "it waits no more: " + std::string(name_of(waited_for)) + "; " + kNeverDrives};
  }
  if (const std::string_view why = wiring_.session.why_never_driven(); !why.empty()) {
    return {request.ticket, false, "it is not driven: " + std::string(why)};
  }
  wiring_.obey(wiring_.session.switch_drive(true, now));
  return {request.ticket, true, when_it_drives()};
}

std::string DriveDesk::when_it_drives() const {
  if (!robot_is_connected()) return "wanders once the robot is connected";
  if (!wiring_.session.stopping_limits().watchdog_s) return "wanders once the robot has told its watchdog";
  return "wanders from the next scan on";
}

control::CommandOutcome DriveDesk::switch_off(std::uint64_t ticket, Timestamp now) {
  wiring_.obey(wiring_.session.switch_drive(false, now));
  if (may_ever_drive_) send_allowed_motion(now);
  const bool is_told = !may_ever_drive_ || (robot_is_connected() && now - robot_heard_at_ < kRobotSilence);
  const std::string told = is_told ? "the robot is told to stand"
                                   : "the robot cannot be told now: what moves goes on until its watchdog; press STOP";
  if (const std::string& why = wiring_.kept.why_not_kept(); !why.empty()) {
    return {ticket, false, told + ". The off is NOT kept on disk: " + why};
  }
  return {ticket, is_told, is_told ? told : "kept, but " + told};
}

// --- a person's hand ---

void DriveDesk::put_in_hand_of(std::uint64_t who) {
  if (in_hand_of_ == who) return;
  in_hand_of_ = who;
  wiring_.log(who != 0 ? "drive: taken by hand" : "drive: let go by hand");
  wiring_.telemetry.by_hand.set(who != 0);
  safety_.release();
}

control::CommandOutcome DriveDesk::take_by_hand(std::uint64_t who, Timestamp asked, Timestamp now) {
  if (!may_ever_drive_) return {who, false, kNeverDrives};
  if (in_hand_of_ != 0) return {who, false, "somebody else drives it by hand"};
  put_in_hand_of(who);
  keep_switch(now);  // "off" on disk before the motors come on: after a crash nobody drives by hand
  const std::string& why = wiring_.kept.why_not_kept();
  control::CommandOutcome outcome =
      why.empty() ? switch_on({true, who, asked}, now)
                  : control::CommandOutcome{who, false, "that the pilot stays off cannot be kept on disk: " + why};
  if (!outcome.done) put_in_hand_of(0);
  return outcome;
}

void DriveDesk::drive_by_hand(std::uint64_t who, const DriveCommand& command) {
  if (in_hand_of_ != who || command.time < hand_moved_ || !wiring_.session.permission().holds()) return;
  hand_moved_ = command.time;
  safety_.command(command, command.time);
}

void DriveDesk::let_go(std::uint64_t who, Timestamp now) {
  if (in_hand_of_ == who) (void)let_drive({false, who, {}}, now);
}

}  // namespace deltamap::daemon
