// SPDX-License-Identifier: Apache-2.0
#include "simulation/faults/named_fault.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <stdexcept>

#include "core/geometry/angle.hpp"

namespace deltamap::simulation {
namespace {

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

constexpr double kPastTheFan_deg = 91.0;

constexpr std::array<NamedFault, 31> kFaults{{
    {"laser-repeats", "the newest scan again and again", "", 0, 0, 0, answer<Answer::kRepeated>, measure_again},
    {"laser-constant", "one range on all beams", "m", 5.0, 0.02, 80.0,
     [](Faults& f, double range_m) {
       f.laser.answer = Answer::kConstant;
       f.laser.constant_m = range_m;
     },
     measure_again},
    {"laser-random", "ranges that mean nothing, up to", "m", 10.0, 0.1, 80.0,
     [](Faults& f, double most_m) {
       f.laser.answer = Answer::kRandom;
       f.laser.random_most_m = most_m;
     },
     measure_again},
    {"laser-beyond-maximum", "\"beyond maximum\" on all beams", "", 0, 0, 0, answer<Answer::kBeyondMaximum>,
     measure_again},
    {"laser-not-valid", "\"not valid\" on all beams", "", 0, 0, 0, answer<Answer::kNotValid>, measure_again},
    {"laser-dazzled", "\"dazzled\" on all beams", "", 0, 0, 0, answer<Answer::kDazzled>, measure_again},
    {"laser-turned", "the fan is turned counter-clockwise against the mount that is told", "deg", 180.0, -180.0, 180.0,
     [](Faults& f, double turned_deg) { f.laser.turned_rad = radians(turned_deg); },
     [](Faults& f) { f.laser.turned_rad = 0.0; }},
    {"laser-upside-down", "left is right", "", 0, 0, 0, [](Faults& f, double) { f.laser.upside_down = true; },
     [](Faults& f) { f.laser.upside_down = false; }},
    {"laser-covered-ahead", "so much of the fan, half of it to each side of straight ahead, is \"beyond maximum\"",
     "deg", 60.0, 1.0, 180.0, [](Faults& f, double width_deg) { cover(f, -0.5 * width_deg, 0.5 * width_deg); },
     uncover},
    {"laser-covered-left", "so much of the fan, from straight left on, is \"beyond maximum\"", "deg", 90.0, 1.0, 180.0,
     [](Faults& f, double width_deg) { cover(f, 90.0 - width_deg, kPastTheFan_deg); }, uncover},
    {"laser-covered-right", "so much of the fan, from straight right on, is \"beyond maximum\"", "deg", 90.0, 1.0,
     180.0, [](Faults& f, double width_deg) { cover(f, -kPastTheFan_deg, width_deg - 90.0); }, uncover},
    {"laser-post", "a post of the robot's own, 6 degrees wide and 0.15 m away, stands in view at", "deg", 60.0, -90.0,
     90.0,
     [](Faults& f, double at_deg) {
       cover(f, at_deg - 3.0, at_deg + 3.0);
       f.laser.covered_answer = BeamKind::kRange;
       f.laser.covered_m = 0.15;
     },
     uncover},
    {"laser-scaled", "all ranges times", "times", 0.9, 0.1, 10.0,
     [](Faults& f, double times) { f.laser.scale = times; }, [](Faults& f) { f.laser.scale = 1.0; }},
    {"laser-stands", "sees from where it was when this began", "", 0, 0, 0,
     [](Faults& f, double) { f.laser.sees_from_where_it_began = true; },
     [](Faults& f) { f.laser.sees_from_where_it_began = false; }},
    {"laser-elsewhere", "sees from a pose so far along the map's x and a quarter turn to the left", "m", 3.0, -100.0,
     100.0,
     [](Faults& f, double along_m) {
       f.laser.moved_on_map = {along_m, 0.0, radians(90.0)};
     },
     [](Faults& f) { f.laser.moved_on_map = {}; }},

    {"wheels-slip", "the body makes so much of the way that the wheels count; 0: it stands", "times", 0.7, 0.0, 3.0,
     grip, grip_again},
    {"wheels-spin", "the wheels turn, the body stands", "", 0, 0, 0, [](Faults& f, double) { grip(f, 0.0); },
     grip_again},
    {"left-wheel-spins", "the left wheel turns and does not move the body", "", 0, 0, 0,
     [](Faults& f, double) { f.body.left_grip = 0.0; }, [](Faults& f) { f.body.left_grip = 1.0; }},
    {"right-wheel-spins", "the right wheel turns and does not move the body", "", 0, 0, 0,
     [](Faults& f, double) { f.body.right_grip = 0.0; }, [](Faults& f) { f.body.right_grip = 1.0; }},
    {"wheels-blocked", "neither wheel turns, and no stall is told", "", 0, 0, 0,
     [](Faults& f, double) { f.body.wheels_blocked = true; }, [](Faults& f) { f.body.wheels_blocked = false; }},
    {"pushed", "someone pushes it ahead, its wheels roll along", "m/s", 0.3, -2.0, 2.0,
     [](Faults& f, double speed) { f.body.pushed_m_per_s = speed; }, [](Faults& f) { f.body.pushed_m_per_s = 0.0; }},
    {"towed", "the body is carried ahead, its wheels are silent", "m/s", 0.3, -2.0, 2.0,
     [](Faults& f, double speed) { f.body.towed_per_s.x = speed; }, [](Faults& f) { f.body.towed_per_s.x = 0.0; }},
    {"turned-by-hand", "the body is turned counter-clockwise, its wheels are silent", "deg/s", 20.0, -180.0, 180.0,
     [](Faults& f, double rate) { f.body.towed_per_s.theta = radians(rate); },
     [](Faults& f) { f.body.towed_per_s.theta = 0.0; }},

    {"keeps-set-points", "it goes on as it was told before; only ESTOP, watchdog and ENABLE 0 stop it", "", 0, 0, 0,
     [](Faults& f, double) { f.controller.keeps_set_points = true; },
     [](Faults& f) { f.controller.keeps_set_points = false; }},
    {"goes-at", "it drives at that speed whatever it is told; only ESTOP, watchdog and ENABLE 0 stop it", "m/s", 0.4,
     -2.0, 2.0, [](Faults& f, double speed) { f.controller.goes_at_m_per_s = speed; },
     [](Faults& f) { f.controller.goes_at_m_per_s.reset(); }},
    {"turns-at", "it turns at that rate whatever it is told; only ESTOP, watchdog and ENABLE 0 stop it", "deg/s", 40.0,
     -300.0, 300.0, [](Faults& f, double rate) { f.controller.turns_at_rad_per_s = radians(rate); },
     [](Faults& f) { f.controller.turns_at_rad_per_s.reset(); }},
    {"speed-factor", "it drives and turns so many times as fast as it is told", "times", 2.0, -3.0, 3.0,
     [](Faults& f, double times) { f.controller.speed_factor = f.controller.turn_factor = times; },
     [](Faults& f) { f.controller.speed_factor = f.controller.turn_factor = 1.0; }},

    {"charger-plugged", "the flag of the charger's power is set, the charge state says no", "", 0, 0, 0,
     [](Faults& f, double) { f.controller.charger_power = true; },
     [](Faults& f) { f.controller.charger_power = false; }},
    {"charge-state", "the charge state's byte (1 bulk, 2 overcharge, 3 float), without the charger's flag", "code", 1.0,
     0.0, 255.0, [](Faults& f, double code) { f.controller.charge_state = static_cast<std::uint8_t>(code); },
     [](Faults& f) { f.controller.charge_state = 0; }},
    {"battery", "the voltage that is told", "V", 0.0, 0.0, 25.0,
     [](Faults& f, double volts) { f.controller.battery_v = volts; },
     [](Faults& f) { f.controller.battery_v.reset(); }},
    {"battery-absent", "no voltage is told", "", 0, 0, 0,
     [](Faults& f, double) { f.controller.tells_no_battery = true; },
     [](Faults& f) { f.controller.tells_no_battery = false; }},
}};

std::string shown(double number) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%g", number);
  return text;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::invalid_argument("fault \"" + text + "\" " + why);
}

const NamedFault& fault_named(std::string_view name, const std::string& text) {
  const auto found =
      std::find_if(kFaults.begin(), kFaults.end(), [&](const NamedFault& fault) { return fault.name == name; });
  if (found != kFaults.end()) return *found;
  std::string names;
  for (const NamedFault& fault : kFaults) names += (names.empty() ? "" : ", ") + std::string(fault.name);
  refuse(text, "is unknown: one of " + names);
}

double number_of(const NamedFault& fault, std::string_view digits, const std::string& text) {
  if (fault.unit.empty()) refuse(text, "takes no number");
  double number = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size() ||
      !(number >= fault.least && number <= fault.most)) {
    refuse(text, "takes a number from " + shown(fault.least) + " to " + shown(fault.most) + " (" +
                     std::string(fault.unit) + ")");
  }
  return number;
}

}  // namespace

std::span<const NamedFault> named_faults() { return kFaults; }

FaultOrder fault_order(const std::string& text, double after_s, std::optional<double> lasts_s) {
  const std::size_t sign = text.find('=');
  const std::string_view whole{text};
  const NamedFault& fault = fault_named(whole.substr(0, sign), text);
  const double number = sign == std::string::npos ? fault.usual : number_of(fault, whole.substr(sign + 1), text);
  return {&fault, number, after_s, lasts_s};
}

std::string described(const FaultOrder& order) {
  std::string text{order.fault->name};
  if (!order.fault->unit.empty()) text += "=" + shown(order.number);
  text += " from " + shown(order.after_s) + " s";
  if (order.lasts_s) text += " for " + shown(*order.lasts_s) + " s";
  return text;
}

void FaultSchedule::apply(double time_s, Faults& faults) {
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    const FaultOrder& order = orders_[i];
    if (states_[i] == State::kOn && order.lasts_s && time_s >= order.after_s + *order.lasts_s) {
      order.fault->clear(faults);
      states_[i] = State::kOver;
    }
    if (states_[i] == State::kWaiting && time_s >= order.after_s) {
      order.fault->set(faults, order.number);
      states_[i] = State::kOn;
    }
  }
}

}  // namespace deltamap::simulation
