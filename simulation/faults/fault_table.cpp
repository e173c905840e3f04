// SPDX-License-Identifier: Apache-2.0
// The table of all faults that can be ordered: scenarios, `deltamap sim` and the bench of faults read this one.
#include <array>

#include "core/geometry/angle.hpp"
#include "drivers/lms200/telegram.hpp"
#include "simulation/faults/named_fault.hpp"

namespace deltamap::simulation {
namespace {

namespace lms200 = drivers::lms200;
using Answer = LaserFaults::Answer;

template <Answer kAnswer>
constexpr void answer(Faults& faults, double /*number*/) {
  faults.laser.answer = kAnswer;
}
void measure_again(Faults& faults) { faults.laser.answer = Answer::kMeasured; }

void cover(Faults& faults, double from_deg, double to_deg) {
  faults.laser.covered_from_rad = radians(from_deg);
  faults.laser.covered_to_rad = radians(to_deg);
}
void uncover(Faults& faults) {
  faults.laser.covered_from_rad = faults.laser.covered_to_rad = 0.0;
  faults.laser.covered_answer = LaserFaults{}.covered_answer;
  faults.laser.covered_m = LaserFaults{}.covered_m;
}

void grip(Faults& faults, double share) { faults.body.left_grip = faults.body.right_grip = share; }
void grip_again(Faults& faults) { grip(faults, 1.0); }

// Of one field, for either line.
template <devices::LineFaults Faults::*kLine, bool devices::LineFaults::*kField>
constexpr NamedFault line_switch(std::string_view name, std::string_view meaning) {
  return {name,
          meaning,
          "",
          0,
          0,
          0,
          [](Faults& f, double) { (f.*kLine).*kField = true; },
          [](Faults& f) { (f.*kLine).*kField = false; }};
}
template <devices::LineFaults Faults::*kLine, double devices::LineFaults::*kField>
constexpr NamedFault line_share(std::string_view name, std::string_view meaning) {
  return {name,
          meaning,
          "share",
          0.2,
          0.001,
          1.0,
          [](Faults& f, double share) { (f.*kLine).*kField = share; },
          [](Faults& f) { (f.*kLine).*kField = 0.0; }};
}
template <devices::LineFaults Faults::*kLine>
constexpr NamedFault line_pauses(std::string_view name, std::string_view meaning) {
  return {name,
          meaning,
          "ms",
          30.0,
          1.0,
          1000.0,
          [](Faults& f, double pause_ms) { (f.*kLine).pause_s = 1e-3 * pause_ms; },
          [](Faults& f) { (f.*kLine).pause_s = 0.0; }};
}
template <devices::LineFaults Faults::*kLine>
constexpr NamedFault line_baud(std::string_view name, std::string_view meaning) {
  return {name,
          meaning,
          "baud",
          19200.0,
          9600.0,
          500000.0,
          [](Faults& f, double baud) { (f.*kLine).baud = static_cast<unsigned>(baud); },
          [](Faults& f) { (f.*kLine).baud.reset(); }};
}
constexpr auto kRobotLine = &Faults::robot_line;
constexpr auto kLaserLine = &Faults::laser_line;
using Line = devices::LineFaults;

void tell_status(Faults& faults, std::uint8_t status) { faults.laser_unit.status = status; }
void tell_status_as_it_is(Faults& faults) { tell_status(faults, 0); }

constexpr double kPastTheFan_deg = 91.0;

constexpr std::array kFaults{
    NamedFault{"laser-repeats", "the newest scan again and again", "", 0, 0, 0, answer<Answer::kRepeated>, measure_again},
    NamedFault{"laser-constant", "one range on all beams", "m", 5.0, 0.02, 80.0,
     [](Faults& f, double range_m) {
       f.laser.answer = Answer::kConstant;
       f.laser.constant_m = range_m;
     },
     measure_again},
    NamedFault{"laser-random", "ranges that mean nothing, up to", "m", 10.0, 0.1, 80.0,
     [](Faults& f, double most_m) {
       f.laser.answer = Answer::kRandom;
       f.laser.random_most_m = most_m;
     },
     measure_again},
    NamedFault{"laser-beyond-maximum", "\"beyond maximum\" on all beams", "", 0, 0, 0, answer<Answer::kBeyondMaximum>,
     measure_again},
    NamedFault{"laser-not-valid", "\"not valid\" on all beams", "", 0, 0, 0, answer<Answer::kNotValid>, measure_again},
    NamedFault{"laser-dazzled", "\"dazzled\" on all beams", "", 0, 0, 0, answer<Answer::kDazzled>, measure_again},
    NamedFault{"laser-zero", "the range 0 on all beams", "", 0, 0, 0, answer<Answer::kZero>, measure_again},
    NamedFault{"laser-turned", "the fan is turned counter-clockwise against the mount that is told", "deg", 180.0, -180.0, 180.0,
     [](Faults& f, double turned_deg) { f.laser.turned_rad = radians(turned_deg); },
     [](Faults& f) { f.laser.turned_rad = 0.0; }},
    NamedFault{"laser-upside-down", "left is right", "", 0, 0, 0, [](Faults& f, double) { f.laser.upside_down = true; },
     [](Faults& f) { f.laser.upside_down = false; }},
    NamedFault{"laser-covered-ahead", "so much of the fan, half of it to each side of straight ahead, is \"beyond maximum\"",
     "deg", 60.0, 1.0, 180.0, [](Faults& f, double width_deg) { cover(f, -0.5 * width_deg, 0.5 * width_deg); },
     uncover},
    NamedFault{"laser-covered-left", "so much of the fan, from straight left on, is \"beyond maximum\"", "deg", 90.0, 1.0, 180.0,
     [](Faults& f, double width_deg) { cover(f, 90.0 - width_deg, kPastTheFan_deg); }, uncover},
    NamedFault{"laser-covered-right", "so much of the fan, from straight right on, is \"beyond maximum\"", "deg", 90.0, 1.0,
     180.0, [](Faults& f, double width_deg) { cover(f, -kPastTheFan_deg, width_deg - 90.0); }, uncover},
    NamedFault{"laser-post", "a post of the robot's own, 6 degrees wide and 0.15 m away, stands in view at", "deg", 60.0, -90.0,
     90.0,
     [](Faults& f, double at_deg) {
       cover(f, at_deg - 3.0, at_deg + 3.0);
       f.laser.covered_answer = BeamKind::kRange;
       f.laser.covered_m = 0.15;
     },
     uncover},
    NamedFault{"laser-scaled", "all ranges times", "times", 0.9, 0.1, 10.0,
     [](Faults& f, double times) { f.laser.scale = times; }, [](Faults& f) { f.laser.scale = 1.0; }},
    NamedFault{"laser-stands", "sees from where it was when this began", "", 0, 0, 0,
     [](Faults& f, double) { f.laser.sees_from_where_it_began = true; },
     [](Faults& f) { f.laser.sees_from_where_it_began = false; }},
    NamedFault{"laser-elsewhere", "sees from a pose so far along the map's x and a quarter turn to the left", "m", 3.0, -100.0,
     100.0,
     [](Faults& f, double along_m) {
       f.laser.moved_on_map = {along_m, 0.0, radians(90.0)};
     },
     [](Faults& f) { f.laser.moved_on_map = {}; }},

    NamedFault{"wheels-slip", "the body makes so much of the way that the wheels count; 0: it stands", "times", 0.7, 0.0, 3.0,
     grip, grip_again},
    NamedFault{"wheels-spin", "the wheels turn, the body stands", "", 0, 0, 0, [](Faults& f, double) { grip(f, 0.0); },
     grip_again},
    NamedFault{"left-wheel-spins", "the left wheel turns and does not move the body", "", 0, 0, 0,
     [](Faults& f, double) { f.body.left_grip = 0.0; }, [](Faults& f) { f.body.left_grip = 1.0; }},
    NamedFault{"right-wheel-spins", "the right wheel turns and does not move the body", "", 0, 0, 0,
     [](Faults& f, double) { f.body.right_grip = 0.0; }, [](Faults& f) { f.body.right_grip = 1.0; }},
    NamedFault{"wheels-blocked", "neither wheel turns, and no stall is told", "", 0, 0, 0,
     [](Faults& f, double) { f.body.wheels_blocked = true; }, [](Faults& f) { f.body.wheels_blocked = false; }},
    NamedFault{"encoders-stand", "the wheels turn and move the body, and count nothing", "", 0, 0, 0,
     [](Faults& f, double) { f.body.counts_nothing = true; }, [](Faults& f) { f.body.counts_nothing = false; }},
    NamedFault{"pushed", "someone pushes it ahead, its wheels roll along", "m/s", 0.3, -2.0, 2.0,
     [](Faults& f, double speed) { f.body.pushed_m_per_s = speed; }, [](Faults& f) { f.body.pushed_m_per_s = 0.0; }},
    NamedFault{"towed", "the body is carried ahead, its wheels are silent", "m/s", 0.3, -2.0, 2.0,
     [](Faults& f, double speed) { f.body.towed_per_s.x = speed; }, [](Faults& f) { f.body.towed_per_s.x = 0.0; }},
    NamedFault{"turned-by-hand", "the body is turned counter-clockwise, its wheels are silent", "deg/s", 20.0, -180.0, 180.0,
     [](Faults& f, double rate) { f.body.towed_per_s.theta = radians(rate); },
     [](Faults& f) { f.body.towed_per_s.theta = 0.0; }},

    NamedFault{"keeps-set-points", "it goes on as it was told before; only ESTOP, watchdog and ENABLE 0 stop it", "", 0, 0, 0,
     [](Faults& f, double) { f.controller.keeps_set_points = true; },
     [](Faults& f) { f.controller.keeps_set_points = false; }},
    NamedFault{"goes-at", "it drives at that speed whatever it is told; only ESTOP, watchdog and ENABLE 0 stop it", "m/s", 0.4,
     -2.0, 2.0, [](Faults& f, double speed) { f.controller.goes_at_m_per_s = speed; },
     [](Faults& f) { f.controller.goes_at_m_per_s.reset(); }},
    NamedFault{"turns-at", "it turns at that rate whatever it is told; only ESTOP, watchdog and ENABLE 0 stop it", "deg/s", 40.0,
     -300.0, 300.0, [](Faults& f, double rate) { f.controller.turns_at_rad_per_s = radians(rate); },
     [](Faults& f) { f.controller.turns_at_rad_per_s.reset(); }},
    NamedFault{"speed-factor", "it drives and turns so many times as fast as it is told", "times", 2.0, -3.0, 3.0,
     [](Faults& f, double times) { f.controller.speed_factor = f.controller.turn_factor = times; },
     [](Faults& f) { f.controller.speed_factor = f.controller.turn_factor = 1.0; }},

    NamedFault{"charger-plugged", "the flag of the charger's power is set, the charge state says no", "", 0, 0, 0,
     [](Faults& f, double) { f.controller.charger_power = true; },
     [](Faults& f) { f.controller.charger_power = false; }},
    NamedFault{"charge-state", "the charge state's byte (1 bulk, 2 overcharge, 3 float), without the charger's flag", "code", 1.0,
     0.0, 255.0, [](Faults& f, double code) { f.controller.charge_state = static_cast<std::uint8_t>(code); },
     [](Faults& f) { f.controller.charge_state = 0; }},
    NamedFault{"battery", "the voltage that is told", "V", 0.0, 0.0, 25.0,
     [](Faults& f, double volts) { f.controller.battery_v = volts; },
     [](Faults& f) { f.controller.battery_v.reset(); }},
    NamedFault{"battery-absent", "no voltage is told", "", 0, 0, 0,
     [](Faults& f, double) { f.controller.tells_no_battery = true; },
     [](Faults& f) { f.controller.tells_no_battery = false; }},

    line_switch<kRobotLine, &Line::is_cut>("robot-cable-cut", "its cable carries nothing in either direction"),
    line_switch<kRobotLine, &Line::is_mute>("robot-mute", "it hears us, we do not hear it"),
    line_switch<kRobotLine, &Line::is_deaf>("robot-deaf", "we hear it, it does not hear us"),
    line_switch<kRobotLine, &Line::is_unplugged>("robot-unplugged", "the adapter is out: its port hangs up and is gone"),
    line_share<kRobotLine, &Line::noisy_share>("robot-noise", "random bytes before so many of its packets"),
    line_share<kRobotLine, &Line::flipped_share>("robot-bit-flips", "one bit is another in so many of its packets"),
    line_share<kRobotLine, &Line::truncated_share>("robot-truncated", "the end is lost of so many of its packets"),
    line_pauses<kRobotLine>("robot-pauses", "so long a pause inside each of its packets"),
    line_baud<kRobotLine>("robot-wrong-baud", "it speaks and hears at that baud, whatever was agreed"),
    NamedFault{"robot-restarts", "its power is cut for a moment: nobody is connected, its pose is 0", "", 0, 0, 0,
               [](Faults& f, double) { ++f.controller.resets; }, nullptr},
    NamedFault{"stop-button", "a person holds it pressed", "", 0, 0, 0,
               [](Faults& f, double) { f.controller.stop_button = true; },
               [](Faults& f) { f.controller.stop_button = false; }},
    NamedFault{"motors-button", "a person presses it once: motors on become off, and off on", "", 0, 0, 0,
               [](Faults& f, double) { ++f.controller.motors_button_presses; }, nullptr},
    NamedFault{"estall", "the E-stall input holds the motors", "", 0, 0, 0,
               [](Faults& f, double) { f.controller.estall = true; },
               [](Faults& f) { f.controller.estall = false; }},
    NamedFault{"stall", "both motors are told to stall", "", 0, 0, 0,
               [](Faults& f, double) { f.controller.tells_stall = true; },
               [](Faults& f) { f.controller.tells_stall = false; }},
    NamedFault{"bumper", "the bumper's segment is pressed, 1 to 5 from the left, whether the robot has one or not", "segment",
               3.0, 1.0, 5.0,
               [](Faults& f, double segment) {
                 f.controller.front_bumpers = static_cast<std::uint8_t>(1u << (static_cast<unsigned>(segment) - 1u));
               },
               [](Faults& f) { f.controller.front_bumpers = 0; }},
    NamedFault{"controller-fault", "the fault flags that it tells", "flags", 1.0, 1.0, 65535.0,
               [](Faults& f, double flags) { f.controller.fault_flags = static_cast<std::uint16_t>(flags); },
               [](Faults& f) { f.controller.fault_flags = 0; }},

    line_switch<kLaserLine, &Line::is_cut>("laser-cable-cut", "its cable carries nothing in either direction"),
    line_switch<kLaserLine, &Line::is_mute>("laser-mute", "it hears us, we do not hear it"),
    line_switch<kLaserLine, &Line::is_deaf>("laser-deaf", "we hear it, it does not hear us"),
    line_switch<kLaserLine, &Line::is_unplugged>("laser-unplugged", "the adapter is out: its port hangs up and is gone"),
    line_share<kLaserLine, &Line::noisy_share>("laser-noise", "random bytes before so many of its telegrams"),
    line_share<kLaserLine, &Line::flipped_share>("laser-bit-flips", "one bit is another in so many of its telegrams"),
    line_share<kLaserLine, &Line::truncated_share>("laser-truncated", "the end is lost of so many of its telegrams"),
    line_pauses<kLaserLine>("laser-pauses", "so long a pause inside each of its telegrams"),
    line_baud<kLaserLine>("laser-wrong-baud", "it speaks and hears at that baud, whatever was agreed"),
    NamedFault{"laser-no-acks", "it obeys and answers, its ACKs are lost", "", 0, 0, 0,
               [](Faults& f, double) { f.laser_unit.sends_no_acks = true; },
               [](Faults& f) { f.laser_unit.sends_no_acks = false; }},
    NamedFault{"laser-naks", "it answers every request by NAK", "", 0, 0, 0,
               [](Faults& f, double) { f.laser_unit.sends_naks = true; },
               [](Faults& f) { f.laser_unit.sends_naks = false; }},
    NamedFault{"laser-restarts", "its power is cut for a moment, and it starts up for so long", "s", 3.0, 0.0, 60.0,
               [](Faults& f, double start_up_s) {
                 ++f.laser_unit.restarts;
                 f.laser_unit.start_up_s = start_up_s;
               },
               nullptr},
    NamedFault{"laser-dirty", "its scans tell that the window is dirty", "", 0, 0, 0,
               [](Faults& f, double) { tell_status(f, lms200::kNormalStatus | lms200::kDirtyWindowBit); },
               tell_status_as_it_is},
    NamedFault{"laser-error", "the severity that its scans tell: 1 info, 2 warning, 3 error, 4 fatal", "severity", 3.0, 1.0,
               4.0,
               [](Faults& f, double severity) {
                 tell_status(f, static_cast<std::uint8_t>(lms200::kNormalStatus | static_cast<unsigned>(severity)));
               },
               tell_status_as_it_is},

    NamedFault{"clock-leaps", "the host's clock leaps so far ahead of the devices', or behind them", "s", 5.0, -60.0, 60.0,
               [](Faults& f, double leap_s) { f.host_clock_ahead_s += leap_s; }, nullptr},
};

}  // namespace

std::span<const NamedFault> named_faults() { return kFaults; }

}  // namespace deltamap::simulation
