// SPDX-License-Identifier: Apache-2.0
#include "tool/live_simulation.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "simulation/devices/pseudo_terminal.hpp"
#include "simulation/devices/tcp_port.hpp"
#include "simulation/simulation.hpp"
#include "tool/fault_orders.hpp"
#include "tool/live_ports.hpp"

namespace deltamap::tool {
namespace {

class TruthFile {
 public:
  TruthFile(const std::optional<std::filesystem::path>& file, const std::string& world, std::uint64_t seed)
      : name_{file ? file->string() : ""} {
    if (!file) return;
    out_.open(*file, std::ios::trunc);
    if (!out_) throw std::runtime_error(file->string() + ": cannot be written: " + std::strerror(errno));
    out_ << simulation::truth_header(world, seed) << std::endl;
    check();
  }
  void write(const std::vector<simulation::TruthRecord>& records) {
    if (!out_.is_open()) return;
    for (const auto& record : records) out_ << simulation::truth_line(record) << '\n';
    if (!records.empty()) out_.flush();  // whoever looks on sees whole lines
    check();
  }

 private:
  void check() const {
    if (!out_) throw std::runtime_error(name_ + ": cannot be written: " + std::strerror(errno));
  }

  std::string name_;
  std::ofstream out_;
};

std::string what_is(int object, const simulation::World& world) {
  const simulation::Object* found = world.find(object);
  if (found == nullptr) return "something that moves";
  switch (found->kind) {
    case simulation::ObjectKind::kWall:
      return "a wall";
    case simulation::ObjectKind::kContainer:
      return "a container";
    case simulation::ObjectKind::kPost:
      return "a post";
    case simulation::ObjectKind::kDoor:
      return "a door";
  }
  return "something";
}

void tell_collisions(const std::vector<simulation::TruthRecord>& records, const simulation::World& world) {
  for (const auto& record : records) {
    const auto* collision = std::get_if<simulation::Collision>(&record);
    if (collision == nullptr) continue;
    const Pose2& at = collision->map_from_robot;
    char line[160];
    (void)std::snprintf(line, sizeof line, "collision with %s at x=%.2f y=%.2f speed=%.2f m/s",
                        what_is(collision->object, world).c_str(), at.x, at.y, collision->speed_m_per_s);
    std::cerr << line << '\n';
  }
}

/// Where a device is reached: a port that may be pulled out and put back.
class Socket {
 public:
  using Open = std::function<std::unique_ptr<simulation::devices::DevicePort>()>;
  explicit Socket(Open open) : open_{std::move(open)}, port_{open_()} {}

  void follow(bool is_there) {
    if (is_there && !port_) port_ = open_();
    if (!is_there) port_.reset();
  }
  [[nodiscard]] std::vector<std::uint8_t> read() { return port_ ? port_->read() : std::vector<std::uint8_t>{}; }
  [[nodiscard]] unsigned baud() const { return port_ ? port_->baud() : 0; }
  void write(const std::vector<std::uint8_t>& bytes) {
    if (port_) port_->write(bytes);
  }
  void watch(std::vector<pollfd>& watched) const {
    if (port_) port_->watch(watched);
  }

 private:
  Open open_;
  std::unique_ptr<simulation::devices::DevicePort> port_;
};

/// The two of a run: links in a folder, or TCP ports.
struct Sockets {
  explicit Sockets(const LiveSimulationOptions& options)
      : folder{options.tcp ? nullptr : std::make_unique<LinksFolder>(options.links)},
        robot{opener(options, "robot", 0)},
        laser{opener(options, "laser", 1)} {}

  std::unique_ptr<LinksFolder> folder;
  Socket robot;
  Socket laser;

 private:
  static Socket::Open opener(const LiveSimulationOptions& options, const char* device, int after) {
    if (options.tcp) {
      const auto number = static_cast<std::uint16_t>(*options.tcp + after);
      return [number] { return std::make_unique<simulation::devices::TcpPort>(number); };
    }
    return [link = options.links / device] { return std::make_unique<simulation::devices::PseudoTerminal>(link); };
  }
};

void tell_places(const LiveSimulationOptions& options) {
  const auto place = [&](const char* device, int after) {
    return options.tcp ? "127.0.0.1:" + std::to_string(*options.tcp + after) : (options.links / device).string();
  };
  std::cerr << "robot=" << place("robot", 0) << " laser=" << place("laser", 1) << " seed=" << options.seed << '\n';
}

/// What has come from the program reaches the devices, and what they have sent until now the program.
void exchange(Sockets& sockets, simulation::Simulation& simulation, Timestamp now) {
  const auto to_robot = sockets.robot.read();
  const auto to_laser = sockets.laser.read();
  const unsigned robot_baud = sockets.robot.baud();
  const unsigned laser_baud = sockets.laser.baud();
  simulation.advance_to(now);
  if (!to_robot.empty()) simulation.send_to_robot(to_robot, robot_baud);
  if (!to_laser.empty()) simulation.send_to_laser(to_laser, laser_baud);
  sockets.robot.write(simulation.bytes_from_robot(robot_baud));
  sockets.laser.write(simulation.bytes_from_laser(laser_baud));
  sockets.robot.follow(simulation.has_robot_port());
  sockets.laser.follow(simulation.has_laser_port());
}

void sleep_until_due(const Sockets& sockets, const OrderLines& orders, Timestamp wake, const SteadyClock& clock,
                     const StopSignals& signals) {
  std::vector<pollfd> watched;
  sockets.robot.watch(watched);
  sockets.laser.watch(watched);
  orders.watch(watched);
  sleep_until(wake, std::move(watched), clock, signals);
}

}  // namespace

void run_live(const simulation::Scenario& scenario, const LiveSimulationOptions& options) {
  const StopSignals signals;
  const SteadyClock clock;
  Sockets sockets{options};
  OrderLines orders{STDIN_FILENO};
  TruthFile truth{options.truth, scenario.file, options.seed};
  const Timestamp start = clock.now();
  simulation::Simulation simulation{scenario, {options.seed, start, options.change_every_s}};
  for (const simulation::FaultOrder& order : scenario.faults) {
    std::cerr << "fault " << simulation::described(order) << ": " << order.fault->meaning << '\n';
  }
  tell_places(options);

  while (!signals.was_asked() && !(options.run_s && seconds(clock.now() - start) >= *options.run_s)) {
    for (const std::string& line : orders.read()) std::cerr << obeyed(line, simulation);
    const auto host_ahead = [&] { return duration_from_seconds(simulation.faults().host_clock_ahead_s); };
    exchange(sockets, simulation, clock.now() - host_ahead());
    const std::vector<simulation::TruthRecord> records = simulation.take_truth();
    truth.write(records);
    tell_collisions(records, simulation.world());
    sleep_until_due(sockets, orders, simulation.next_event() + host_ahead(), clock, signals);
  }
  std::cerr << "collisions=" << simulation.collisions().size() << '\n';
}

}  // namespace deltamap::tool
