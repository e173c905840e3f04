// SPDX-License-Identifier: Apache-2.0
// A scripted robot for session tests: waits, syncs, connects, sends SIPs, loses commands that come too close, and has a
// watchdog that resumes the old set points at the next packet (protocols.md A4, A9).
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/status.hpp"
#include "tests/support/bytes/conversation.hpp"

namespace deltamap::drivers::pioneer {

class FakeRobot {
 public:
  explicit FakeRobot(unsigned baud) : decoder_{baud} {}

  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }

  void take(const std::vector<std::uint8_t>& bytes, Timestamp now) {
    for (const Packet& packet : decoder_.decode(bytes, now)) {
      const Timestamp is_here = now + line_time(bytes.size(), baud());
      const bool came_too_soon = now < busy_until_;
      busy_until_ = is_here + std::chrono::milliseconds{3};
      if (came_too_soon || is_deaf) {
        ++lost;
        continue;
      }
      if (const auto command = decoded_command(packet.data)) obey(*command, is_here);
    }
  }

  void tick(Timestamp now) {
    if (new_baud_ && now >= new_baud_at_) {
      decoder_.set_baud(*new_baud_);
      new_baud_.reset();
    }
    const int watchdog_ms = config.watchdog_ms.value_or(0);
    const bool is_due = watchdog_ms > 0 && now - last_heard_ > std::chrono::milliseconds{watchdog_ms};
    if (connected && is_due) watchdog_has_stopped = true;
    moves = connected && motors_on && !watchdog_has_stopped && (speed != 0 || turn_rate != 0);
    has_ever_moved = has_ever_moved || moves;
    if (!connected || is_mute || now < next_sip_) return;
    next_sip_ = now + std::chrono::milliseconds{100};
    if (moves) sip.x_units = static_cast<std::uint16_t>((sip.x_units + speed / 10) & 0x7FFF);
    sip.moving = moves;
    sip.flags = static_cast<std::uint16_t>((motors_on ? sip_flag::kMotorsEnabled : 0) |
                                           (stop_button ? sip_flag::kStopButton : 0) |
                                           (estall ? sip_flag::kEstall : 0) | (sonar_on ? sip_flag::kSonarArrays : 0));
    send(encoded_sip(sip), now);
  }

  /// A client went away without a word while the robot was driving; the watchdog has stopped it.
  void be_left_over(int speed_mm_per_s) {
    connected = true;
    motors_on = true;
    speed = speed_mm_per_s;
    watchdog_has_stopped = true;
  }

  bool connected = false;
  bool motors_on = false;
  bool sonar_on = true;
  bool stop_button = false;
  bool estall = false;  ///< shown; ENABLE 1 is obeyed all the same
  bool watchdog_has_stopped = false;
  bool moves = false;
  bool has_ever_moved = false;
  bool is_mute = false;  ///< SIPs stop
  bool is_deaf = false;  ///< commands are lost
  bool follows_host_baud = true;
  bool takes_limits = true;
  bool tells_config = true;
  unsigned idle_baud = 0;  ///< fallen back to at CLOSE; 0: stays
  int closes_to_lose = 0;
  int sync1_to_garble = 0;  ///< answers of type FF
  int speed = 0;
  int turn_rate = 0;
  int lost = 0;
  std::vector<Command> obeyed;
  ConfigPacket config;
  RobotIdentity identity{"mapper", "Pioneer", "p3dx-sh"};
  Sip sip;
  std::vector<tests::SentBytes> outgoing;

 private:
  void obey(const Command& command, Timestamp now) {
    obeyed.push_back(command);
    last_heard_ = now;
    if (connected) {
      obey_connected(command, now);
    } else {
      obey_waiting(command, now);
    }
  }

  void obey_waiting(const Command& command, Timestamp now) {
    const auto step = static_cast<std::uint8_t>(command.number);
    if (step == kSync1 && sync_step_ == 2 + 1) {
      connect(now);
    } else if (step == kSync1 && sync1_to_garble > 0) {
      --sync1_to_garble;
      sync_step_ = 0;
      send(encoded_packet(std::vector<std::uint8_t>{0xFF}), now);
    } else if (step == kSync0) {
      sync_step_ = 1;
      send(encoded_packet(std::vector<std::uint8_t>{kSync0}), now);
    } else if (step == kSync1 && sync_step_ == 1) {
      sync_step_ = 2;
      send(encoded_packet(std::vector<std::uint8_t>{kSync1}), now);
    } else if (step == kSync2 && sync_step_ == 2) {
      sync_step_ = 3;
      send(encoded_identity(identity), now);
    }
  }

  void connect(Timestamp now) {
    connected = true;
    motors_on = false;
    watchdog_has_stopped = false;
    sync_step_ = 0;
    next_sip_ = now + std::chrono::milliseconds{50};
  }

  void obey_connected(const Command& command, Timestamp now) {
    watchdog_has_stopped = false;  // any packet: the set points below may stop it again
    const int value = command.integer_or(0);
    switch (command.number) {
      case CommandNumber::kClose:
        if (closes_to_lose-- > 0) return;
        connected = false;
        motors_on = false;
        speed = turn_rate = 0;
        if (idle_baud != 0) decoder_.set_baud(idle_baud);
        break;
      case CommandNumber::kEstop:
        speed = turn_rate = 0;
        break;
      case CommandNumber::kVel:
        speed = value;
        break;
      case CommandNumber::kRvel:
        turn_rate = value;
        break;
      case CommandNumber::kEnable:
        motors_on = value == 1 && !stop_button;
        break;
      case CommandNumber::kSonar:
        sonar_on = value == 1;
        break;
      case CommandNumber::kConfig:
        if (tells_config) send(encoded_config(config), now);
        break;
      case CommandNumber::kSetV:
      case CommandNumber::kSetRv:
      case CommandNumber::kSetA:
      case CommandNumber::kSetRa:
        if (takes_limits) take_limit(command.number, value);
        break;
      case CommandNumber::kHostBaud:
        if (follows_host_baud) {
          new_baud_ = baud_of_host_code(value);
          new_baud_at_ = now + std::chrono::milliseconds{2};
        }
        break;
      default:
        break;
    }
  }

  void take_limit(CommandNumber number, int value) {
    const auto magnitude = static_cast<std::uint16_t>(std::abs(value));
    if (number == CommandNumber::kSetV) config.trans_vel_max = magnitude;
    if (number == CommandNumber::kSetRv) config.rot_vel_max = magnitude;
    if (number == CommandNumber::kSetA) (value > 0 ? config.trans_acc : config.trans_decel) = magnitude;
    if (number == CommandNumber::kSetRa) (value > 0 ? config.rot_acc : config.rot_decel) = magnitude;
  }

  void send(std::vector<std::uint8_t> bytes, Timestamp now) {
    const Timestamp begin = std::max(now, line_free_);
    line_free_ = begin + line_time(bytes.size(), baud());
    outgoing.push_back({line_free_, std::move(bytes)});
  }

  PacketDecoder decoder_;
  int sync_step_ = 0;
  Timestamp busy_until_ = Timestamp::min();
  Timestamp last_heard_;
  Timestamp next_sip_;
  Timestamp line_free_;
  std::optional<unsigned> new_baud_;
  Timestamp new_baud_at_;
};

}  // namespace deltamap::drivers::pioneer
