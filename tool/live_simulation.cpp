// SPDX-License-Identifier: Apache-2.0
#include "tool/live_simulation.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "simulation/simulation.hpp"
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

}  // namespace

void run_live(const simulation::Scenario& scenario, const LiveSimulationOptions& options) {
  const StopSignals signals;
  const SteadyClock clock;
  LivePorts ports{options.links};
  TruthFile truth{options.truth, scenario.file, options.seed};
  const Timestamp start = clock.now();
  simulation::Simulation simulation{scenario, {options.seed, start, options.change_every_s}};
  for (const simulation::FaultOrder& order : scenario.faults) {
    std::cerr << "fault " << simulation::described(order) << ": " << order.fault->meaning << '\n';
  }
  std::cerr << "robot=" << (options.links / "robot").string() << " laser=" << (options.links / "laser").string()
            << " seed=" << options.seed << '\n';

  while (!signals.was_asked() && !(options.run_s && seconds(clock.now() - start) >= *options.run_s)) {
    const auto to_robot = ports.robot.read();
    const auto to_laser = ports.laser.read();
    const unsigned robot_baud = ports.robot.baud();
    const unsigned laser_baud = ports.laser.baud();
    simulation.advance_to(clock.now());
    if (!to_robot.empty()) simulation.send_to_robot(to_robot, robot_baud);
    if (!to_laser.empty()) simulation.send_to_laser(to_laser, laser_baud);
    ports.robot.write(simulation.bytes_from_robot(robot_baud));
    ports.laser.write(simulation.bytes_from_laser(laser_baud));
    const std::vector<simulation::TruthRecord> records = simulation.take_truth();
    truth.write(records);
    tell_collisions(records, simulation.world());
    ports.sleep_until(simulation.next_event(), clock, signals);
  }
  std::cerr << "collisions=" << simulation.collisions().size() << '\n';
}

}  // namespace deltamap::tool
