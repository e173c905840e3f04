// SPDX-License-Identifier: Apache-2.0
// A simulated robot and its laser behind two ports of the live pipeline, in real time, in the io thread; and every
// command that was sent to the robot.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/port/byte_port.hpp"
#include "drivers/port/byte_record.hpp"
#include "drivers/port/port_clock.hpp"
#include "drivers/port/serial_port.hpp"
#include "simulation/simulation.hpp"

namespace deltamap::test {

class SimulatedPorts {
 public:
  using PortId = drivers::port::PortId;

  SimulatedPorts(const simulation::Scenario& scenario, std::uint64_t seed)
      : simulation_{scenario, {.seed = seed, .start = drivers::port::port_clock_now(), .change_every_s = {}}} {}

  [[nodiscard]] drivers::port::SerialPortAnswer open(boost::asio::io_context& loop, PortId id, unsigned baud) {
    if (!timer_) {
      timer_.emplace(loop);
      tick();
    }
    if (id == PortId::kRobot && is_robot_unplugged_) return {nullptr, "robot is missing"};
    return {std::make_unique<Port>(*this, id, baud), ""};
  }
  /// The robot tells a battery of 10 V from now on. Any thread.
  void drain_battery() { is_drained_ = true; }
  /// The robot's port hangs up, and is missing from now on. Any thread.
  void unplug_robot() { is_robot_unplugged_ = true; }
  /// Whether the robot hears what it is asked about its configuration. Any thread.
  void hear_config(bool hears) { hears_config_ = hears; }
  /// In the io thread's last moments, or after it: nothing comes any more.
  void end() { timer_.reset(); }

  struct SentCommand {
    std::uint8_t number = 0;
    std::vector<std::uint8_t> argument;  ///< with its type byte
    Timestamp sent{};
  };
  /// What the robot was told so far. Any thread.
  [[nodiscard]] std::vector<SentCommand> commands() const {
    const std::scoped_lock lock{mutex_};
    return commands_;
  }

 private:
  class Port final : public drivers::port::BytePort {
   public:
    Port(SimulatedPorts& ports, PortId id, unsigned baud) : ports_{ports}, id_{id}, baud_{baud}, name_{name_of(id)} {}
    ~Port() override { ports_.handlers(id_) = {}; }
    void start(drivers::port::PortHandlers handlers) override {
      ports_.handlers(id_) = std::move(handlers);
      ports_.baud(id_) = baud_;
    }
    void write(std::span<const std::uint8_t> bytes) override { ports_.write(id_, bytes); }
    void set_baud(unsigned baud) override { ports_.baud(id_) = baud_ = baud; }
    void discard_input() override { (void)ports_.fetch(id_); }
    void await(std::size_t) override {}
    [[nodiscard]] const std::string& name() const override { return name_; }
    [[nodiscard]] unsigned baud() const override { return baud_; }

   private:
    SimulatedPorts& ports_;
    PortId id_;
    unsigned baud_;
    std::string name_;
  };

  [[nodiscard]] drivers::port::PortHandlers& handlers(PortId id) { return handlers_[id == PortId::kRobot ? 0 : 1]; }
  [[nodiscard]] unsigned& baud(PortId id) { return bauds_[id == PortId::kRobot ? 0 : 1]; }

  void write(PortId id, std::span<const std::uint8_t> bytes) {
    const Timestamp now = drivers::port::port_clock_now();
    simulation_.advance_to(now);
    if (id == PortId::kLaser) return simulation_.send_to_laser(bytes, baud(id));
    const auto packets = decoder_.decode(bytes, now);
    const bool asks_config = std::any_of(packets.begin(), packets.end(), [](const drivers::pioneer::Packet& packet) {
      return packet.type() == static_cast<std::uint8_t>(drivers::pioneer::CommandNumber::kConfig);
    });
    if (hears_config_ || !asks_config) simulation_.send_to_robot(bytes, baud(id));
    const std::scoped_lock lock{mutex_};
    for (const auto& packet : packets) {
      commands_.push_back({packet.type(), {packet.body().begin(), packet.body().end()}, now});
    }
  }

  [[nodiscard]] std::vector<std::uint8_t> fetch(PortId id) {
    return id == PortId::kRobot ? simulation_.bytes_from_robot(baud(id)) : simulation_.bytes_from_laser(baud(id));
  }

  void tick() {
    timer_->expires_after(std::chrono::milliseconds(5));
    timer_->async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      simulation_.advance_to(drivers::port::port_clock_now());
      if (is_drained_.exchange(false)) {
        const drivers::pioneer::Command fake{drivers::pioneer::CommandNumber::kBatTest, 100};
        simulation_.send_to_robot(drivers::pioneer::encoded_command(fake), baud(PortId::kRobot));
      }
      if (const auto hang_up = handlers(PortId::kRobot).on_closed; hang_up && is_robot_unplugged_) {
        handlers(PortId::kRobot) = {};
        hang_up("the device hung up");
      }
      for (const PortId id : {PortId::kRobot, PortId::kLaser}) {
        if (!handlers(id).on_bytes) continue;
        const auto bytes = fetch(id);
        const auto take = handlers(id).on_bytes;
        if (!bytes.empty()) take(bytes, drivers::port::port_clock_now());
      }
      tick();
    });
  }

  simulation::Simulation simulation_;
  std::atomic<bool> is_drained_ = false;
  std::atomic<bool> is_robot_unplugged_ = false;
  std::atomic<bool> hears_config_ = true;
  std::optional<boost::asio::steady_timer> timer_;
  drivers::port::PortHandlers handlers_[2];
  unsigned bauds_[2] = {9600, 9600};
  drivers::pioneer::PacketDecoder decoder_{38400};
  mutable std::mutex mutex_;
  std::vector<SentCommand> commands_;
};

}  // namespace deltamap::test
