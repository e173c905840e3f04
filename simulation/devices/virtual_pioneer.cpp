// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/virtual_pioneer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/odometry.hpp"

namespace deltamap::simulation::devices {
namespace {

namespace pioneer = drivers::pioneer;
using pioneer::Command;
using pioneer::CommandNumber;

constexpr double kSonarCycle_s = 0.04;  // A5: SONARCYCLE as delivered
constexpr double kSonarReach_m = 5.0;
constexpr double kTicksPerMetre = 128'000.0;  // A10: TICKSMM 128
constexpr std::uint16_t kFifteenBits = 0x7FFF;
constexpr int kBumperSegments = 5;  // front and rear each

std::uint16_t wrapped_units(double metres, double metres_per_unit) {
  return static_cast<std::uint16_t>(std::llround(metres / metres_per_unit) & kFifteenBits);
}

std::int16_t heading_units(double heading_rad) {
  const double units = heading_rad * pioneer::kHeadingUnitsPerTurn / (2.0 * std::numbers::pi);
  return static_cast<std::int16_t>(std::lround(units));
}

bool is_limit(const Command& command) {
  return command.number == CommandNumber::kSetV || command.number == CommandNumber::kSetRv ||
         command.number == CommandNumber::kSetA || command.number == CommandNumber::kSetRa;
}

std::uint16_t whole(double value) { return static_cast<std::uint16_t>(std::lround(value)); }

std::int16_t millimetres(double metres) { return static_cast<std::int16_t>(std::lround(1000.0 * metres)); }

}  // namespace

VirtualPioneer::VirtualPioneer(const PioneerSetup& setup, Random random)
    : setup_{setup}, kind_{kind_of(setup.model)}, random_{random}, line_{setup.baud, random}, decoder_{setup.baud} {}

void VirtualPioneer::receive(std::span<const std::uint8_t> bytes, unsigned host_baud, Timestamp now) {
  if (state_ == State::kMaintenance) return;
  const auto heard = garbled(bytes, host_baud, line_.baud(), random_);
  for (const pioneer::Packet& packet : decoder_.decode(heard, now)) {
    if (const auto command = pioneer::decoded_command(packet.data)) take(*command, packet.data, now);
  }
}

void VirtualPioneer::take(const Command& command, std::span<const std::uint8_t> data, Timestamp now) {
  last_packet_ = now;
  watchdog_fired_ = false;  // any packet lets the old set points act again (A9)
  if (command.number == CommandNumber::kReset) return reset(now);
  if (command.number == CommandNumber::kMaintenance) {
    disconnect();
    state_ = State::kMaintenance;
    return;
  }
  if (state_ == State::kConnected) return obey(command, now);
  if (!data.empty()) synchronize(command, now);
}

/// A4: each step answers with its echo; OPEN counts only after SYNC2.
void VirtualPioneer::synchronize(const Command& command, Timestamp now) {
  const auto echo = [&](std::uint8_t number) { line_.send(pioneer::encoded_packet(std::vector{number}), now); };
  if (command.number == CommandNumber::kPulse) {
    echo(pioneer::kSync0);
    state_ = State::kAwaitingSync1;
  } else if (command.number == CommandNumber::kOpen && state_ == State::kAwaitingSync1) {
    echo(pioneer::kSync1);
    state_ = State::kAwaitingSync2;
  } else if (command.number == CommandNumber::kClose && state_ == State::kAwaitingSync2) {
    line_.send(identity_frame(), now);
    state_ = State::kAwaitingOpen;
  } else if (command.number == CommandNumber::kOpen && state_ == State::kAwaitingOpen) {
    state_ = State::kConnected;
    motors_enabled_ = false;  // always, even those that a button has switched on meanwhile
    sonar_on_ = setup_.sonars > 0;
    sonar_fired_ = 0;
    opened_ = now;
    next_sip_ = now + duration_from_seconds(setup_.sip_cycle_s);
  }
}

void VirtualPioneer::obey(const Command& command, Timestamp now) {
  if (!setup_.takes_limits && is_limit(command)) return;
  if (faults_.keeps_set_points && SetPoints::is_set_point(command.number)) return;
  if (set_points_.take(command, motion_)) return;
  const int value = command.integer_or(1);
  switch (command.number) {
    case CommandNumber::kClose:
      disconnect();
      break;
    case CommandNumber::kEnable:
      motors_enabled_ = value != 0 && !stop_button_;
      break;
    case CommandNumber::kSetO:
      set_pose_to_zero();
      break;
    case CommandNumber::kConfig:
      line_.send(config_frame(), now);
      break;
    case CommandNumber::kSonar:
      sonar_on_ = value != 0 && setup_.sonars > 0;
      break;
    case CommandNumber::kEncoder:
      encoder_stream_ = value > 0;
      break;
    case CommandNumber::kIoRequest:
      io_stream_ = value > 0;
      break;
    case CommandNumber::kBatTest: {
      fake_battery_decivolts_.reset();
      if (value != 0) fake_battery_decivolts_ = value;
      break;
    }
    case CommandNumber::kHostBaud:
      if (const auto baud = pioneer::baud_of_host_code(value); baud && setup_.can_change_baud) set_baud(*baud);
      break;
    default:
      break;  // PULSE, and what a stock P3-DX has no hardware for
  }
}

void VirtualPioneer::suffer(const ControllerFaults& faults, Timestamp now) {
  const ControllerFaults before = std::exchange(faults_, faults);
  if (faults.resets != before.resets) reset(now);
  if (faults.stop_button != before.stop_button) faults.stop_button ? press_stop_button() : release_stop_button();
  if (faults.estall != before.estall) faults.estall ? begin_estall() : end_estall();
  if (faults.motors_button_presses != before.motors_button_presses) press_motors_button();
  if (faults.fault_flags != before.fault_flags) fail(faults.fault_flags);
}

void VirtualPioneer::suffer(const LineFaults& faults) {
  const unsigned before = line_.baud();
  line_.suffer(faults);
  if (line_.baud() != before) decoder_.set_baud(line_.baud());
}

void VirtualPioneer::disconnect() {
  state_ = State::kAwaitingSync0;
  motors_enabled_ = sonar_on_ = encoder_stream_ = io_stream_ = false;
  set_points_ = SetPoints{};
  set_baud(setup_.baud);
}

void VirtualPioneer::set_baud(unsigned baud) {
  line_.set_baud(baud);
  decoder_.set_baud(line_.baud());
}

void VirtualPioneer::reset(Timestamp now) {
  line_.interrupt(now);
  disconnect();
  stop_button_ = watchdog_fired_ = false;
  fake_battery_decivolts_.reset();
  set_pose_to_zero();
}

void VirtualPioneer::set_pose_to_zero() {
  wheels_from_zero_ = wheels_from_robot_;
  motion_.odom_from_robot = Pose2{};
}

void VirtualPioneer::advance(Timestamp now, const WheelMotion& motion, const Sonar& sonar) {
  motion_ = motion;
  wheels_from_robot_ = motion.odom_from_robot;
  motion_.odom_from_robot = motion_between(wheels_from_zero_, wheels_from_robot_);
  if (state_ != State::kConnected) return;
  if (now - last_packet_ > duration_from_seconds(setup_.watchdog_s)) watchdog_fired_ = true;
  while (next_sip_ <= now) {
    // A line that is a whole cycle behind skips one, as the controller does.
    if (line_.idle_at() < now + duration_from_seconds(setup_.sip_cycle_s)) send_cycle(next_sip_, sonar);
    next_sip_ += duration_from_seconds(setup_.sip_cycle_s);
  }
}

void VirtualPioneer::send_cycle(Timestamp now, const Sonar& sonar) {
  line_.send(pioneer::encoded_sip(sip(now, sonar)), now);
  if (encoder_stream_) {
    const double turned_m = motion_.turned_rad * kind_.half_track_m;
    line_.send(pioneer::encoded_encoder(
                   {static_cast<std::int32_t>(std::llround((motion_.travelled_m - turned_m) * kTicksPerMetre)),
                    static_cast<std::int32_t>(std::llround((motion_.travelled_m + turned_m) * kTicksPerMetre))}),
               now);
  }
  if (io_stream_) line_.send(pioneer::encoded_io({{0}, {0}, {0, 0, 0, 0}}), now);
}

pioneer::Sip VirtualPioneer::sip(Timestamp now, const Sonar& sonar) {
  const Pose2& pose = motion_.odom_from_robot;
  const double turn_m_per_s = motion_.turn_rate_rad_per_s * kind_.half_track_m;
  pioneer::Sip sip;
  sip.moving = motion_.speed_m_per_s != 0.0 || motion_.turn_rate_rad_per_s != 0.0;
  sip.x_units = wrapped_units(pose.x, kind_.metres_per_unit);
  sip.y_units = wrapped_units(pose.y, kind_.metres_per_unit);
  sip.heading_units = heading_units(pose.theta);
  sip.left_mm_per_s = millimetres(motion_.speed_m_per_s - turn_m_per_s);
  sip.right_mm_per_s = millimetres(motion_.speed_m_per_s + turn_m_per_s);
  sip.control_units = heading_units(set_points_.heading_rad().value_or(pose.theta));
  if (motors_enabled_) sip.flags |= pioneer::sip_flag::kMotorsEnabled;
  if (stop_button_) sip.flags |= pioneer::sip_flag::kStopButton;
  if (estall_) sip.flags |= pioneer::sip_flag::kEstall;
  if (sonar_on_) sip.flags |= std::uint16_t{1} << 1;
  if (faults_.charger_power) sip.flags |= pioneer::sip_flag::kChargerPower;
  add_contact(sip);
  add_sonar(sip, now, sonar);
  sip.grip_state = std::uint8_t{0};
  sip.analog_port = std::uint8_t{0};
  sip.analog = std::uint8_t{0};
  sip.digital_in = std::uint8_t{0};
  sip.digital_out = std::uint8_t{0};
  sip.charge_state = faults_.charge_state;
  sip.turn_rate_decideg_per_s = static_cast<std::int16_t>(std::lround(10.0 * degrees(motion_.turn_rate_rad_per_s)));
  sip.fault_flags = fault_flags_;
  add_battery(sip);
  return sip;
}

void VirtualPioneer::add_battery(pioneer::Sip& sip) const {
  if (faults_.tells_no_battery) return;
  const double battery_v = faults_.battery_v.value_or(setup_.battery_v);
  const int decivolts = fake_battery_decivolts_.value_or(static_cast<int>(std::lround(10.0 * battery_v)));
  sip.battery_decivolts = static_cast<std::uint8_t>(std::clamp(decivolts, 0, 255));
  sip.battery_x10_decivolts = static_cast<std::uint16_t>(decivolts);
}

void VirtualPioneer::add_contact(pioneer::Sip& sip) const {
  sip.left_stall = sip.right_stall = motion_.stalled || faults_.tells_stall;
  sip.front_bumpers = faults_.front_bumpers;
  if (!setup_.has_bumpers || !motion_.contact_bearing_rad) return;
  // Segments are numbered clockwise as the robot sees its front, and as one behind sees its rear.
  const bool front = std::abs(*motion_.contact_bearing_rad) <= 0.5 * std::numbers::pi;
  const double from_middle_rad =
      front ? -*motion_.contact_bearing_rad : -wrapped_angle(*motion_.contact_bearing_rad - std::numbers::pi);
  const int segment = std::clamp(static_cast<int>(std::lround(from_middle_rad / radians(36.0))) + kBumperSegments / 2,
                                 0, kBumperSegments - 1);
  (front ? sip.front_bumpers : sip.rear_bumpers) |= static_cast<std::uint8_t>(1u << segment);
}

/// A sonar of each array fires every 40 ms; a SIP tells the readings that are new.
void VirtualPioneer::add_sonar(pioneer::Sip& sip, Timestamp now, const Sonar& sonar) {
  if (!sonar_on_ || !sonar) return;
  const int due = static_cast<int>(seconds(now - opened_) / kSonarCycle_s);
  for (; sonar_fired_ < due; ++sonar_fired_) {
    for (int array = 0; array < setup_.sonars / 8; ++array) {
      const int index = 8 * array + sonar_fired_ % 8;
      const double range_m = std::min(kSonarReach_m, sonar(index).value_or(kSonarReach_m));
      sip.sonar.push_back(
          {static_cast<std::uint8_t>(index), static_cast<std::uint16_t>(std::lround(1000.0 * range_m))});
    }
  }
}

std::optional<Timestamp> VirtualPioneer::next_event() const {
  std::optional<Timestamp> next = line_.burst_whole_at();
  if (state_ == State::kConnected) next = next ? std::min(*next, next_sip_) : next_sip_;
  return next;
}

DriveTarget VirtualPioneer::demand() const {
  const bool may_move = state_ == State::kConnected && motors_enabled_ && !watchdog_fired_;
  if (!may_move) return set_points_.standstill();
  DriveTarget demand = set_points_.demand(motion_);
  if (set_points_.is_emergency()) return demand;
  demand.speed_m_per_s = faults_.goes_at_m_per_s.value_or(faults_.speed_factor * demand.speed_m_per_s);
  demand.turn_rate_rad_per_s = faults_.turns_at_rad_per_s.value_or(faults_.turn_factor * demand.turn_rate_rad_per_s);
  return demand;
}

std::vector<std::uint8_t> VirtualPioneer::config_frame() const {
  pioneer::ConfigPacket config;
  config.subtype = setup_.model;
  config.serial_number = "SIM0001";
  config.name = "deltamap-sim";
  config.sip_cycle_ms = static_cast<std::uint8_t>(std::lround(1000.0 * setup_.sip_cycle_s));
  config.host_baud = static_cast<std::uint8_t>(pioneer::host_baud_code(setup_.baud).value_or(0));
  config.watchdog_ms = static_cast<std::uint16_t>(std::lround(1000.0 * setup_.watchdog_s));
  config.front_sonar = setup_.sonars > 0 ? 1 : 0;
  config.rear_sonar = setup_.sonars > 8 ? 1 : 0;
  config.front_bumpers = config.rear_bumpers = setup_.has_bumpers ? kBumperSegments : 0;
  config.trans_vel_max = whole(1000.0 * set_points_.max_speed_m_per_s());
  config.rot_vel_max = whole(degrees(set_points_.max_turn_rate_rad_per_s()));
  config.trans_acc = whole(1000.0 * set_points_.rates().acceleration_m_per_s2);
  config.trans_decel = whole(1000.0 * set_points_.rates().deceleration_m_per_s2);
  config.rot_acc = whole(degrees(set_points_.rates().turn_acceleration_rad_per_s2));
  config.rot_decel = whole(degrees(set_points_.rates().turn_deceleration_rad_per_s2));
  config.auto_baud = setup_.can_change_baud ? 1 : 0;
  config.firmware_version = "2.9";
  return pioneer::encoded_config(config);
}

std::vector<std::uint8_t> VirtualPioneer::identity_frame() const {
  return pioneer::encoded_identity({"deltamap-sim", "Pioneer", setup_.model});
}

}  // namespace deltamap::simulation::devices
