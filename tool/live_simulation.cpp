// SPDX-License-Identifier: Apache-2.0
#include "tool/live_simulation.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "simulation/devices/pseudo_terminal.hpp"
#include "simulation/simulation.hpp"

namespace deltamap::tool {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int) { stop_requested = 1; }

/// Signals end the run, and arrive only while it sleeps: none is missed between looking and sleeping.
class StopSignals {
 public:
  StopSignals() {
    stop_requested = 0;
    struct sigaction action {};
    action.sa_handler = request_stop;
    sigemptyset(&action.sa_mask);
    sigset_t held;
    sigemptyset(&held);
    for (const int signal : {SIGTERM, SIGINT}) {
      ::sigaction(signal, &action, nullptr);
      sigaddset(&held, signal);
    }
    ::pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~StopSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] const sigset_t& while_asleep() const { return before_; }

 private:
  sigset_t before_{};
};

Duration reading_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec};
}

/// Monotonic, with its offset to Unix time fixed at the start, as of drivers/port/port_clock.hpp.
class SteadyClock {
 public:
  SteadyClock() : offset_{reading_of(CLOCK_REALTIME) - reading_of(CLOCK_MONOTONIC)} {}
  [[nodiscard]] Timestamp now() const { return Timestamp{reading_of(CLOCK_MONOTONIC) + offset_}; }

 private:
  Duration offset_;
};

/// One simulator a folder; a lock, because links stay behind when a simulator is killed.
class LinksFolder {
 public:
  explicit LinksFolder(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ < 0) throw std::runtime_error(folder.string() + ": " + std::strerror(errno));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(descriptor_);
    throw std::runtime_error(folder.string() + ": another simulator has its links here");
  }
  ~LinksFolder() { ::close(descriptor_); }
  LinksFolder(const LinksFolder&) = delete;
  LinksFolder& operator=(const LinksFolder&) = delete;

 private:
  int descriptor_;
};

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

/// Sleeps until a moment, until a program has written to one of the ports, or until a signal.
void sleep_until(Timestamp wake, const SteadyClock& clock, const StopSignals& signals,
                 std::array<simulation::devices::PseudoTerminal*, 2> ports) {
  std::array<pollfd, 2> watched{};
  nfds_t count = 0;
  for (const auto* port : ports) {
    if (port->is_open_elsewhere()) watched[count++] = {port->descriptor(), POLLIN, 0};
  }
  const Duration left = std::max(Duration{0}, wake - clock.now());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
  ::ppoll(watched.data(), count, &timeout, &signals.while_asleep());
}

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
  const LinksFolder folder{options.links};
  simulation::devices::PseudoTerminal robot_port{options.links / "robot"};
  simulation::devices::PseudoTerminal laser_port{options.links / "laser"};
  TruthFile truth{options.truth, scenario.file, options.seed};
  const Timestamp start = clock.now();
  simulation::Simulation simulation{scenario, {options.seed, start, options.change_every_s}};
  for (const simulation::FaultOrder& order : scenario.faults) {
    std::cerr << "fault " << simulation::described(order) << ": " << order.fault->meaning << '\n';
  }
  std::cerr << "robot=" << (options.links / "robot").string() << " laser=" << (options.links / "laser").string()
            << " seed=" << options.seed << '\n';

  while (stop_requested == 0 && !(options.run_s && seconds(clock.now() - start) >= *options.run_s)) {
    const auto to_robot = robot_port.read();
    const auto to_laser = laser_port.read();
    const unsigned robot_baud = robot_port.baud();
    const unsigned laser_baud = laser_port.baud();
    simulation.advance_to(clock.now());
    if (!to_robot.empty()) simulation.send_to_robot(to_robot, robot_baud);
    if (!to_laser.empty()) simulation.send_to_laser(to_laser, laser_baud);
    robot_port.write(simulation.bytes_from_robot(robot_baud));
    laser_port.write(simulation.bytes_from_laser(laser_baud));
    const std::vector<simulation::TruthRecord> records = simulation.take_truth();
    truth.write(records);
    tell_collisions(records, simulation.world());
    sleep_until(simulation.next_event(), clock, signals, {&robot_port, &laser_port});
  }
  std::cerr << "collisions=" << simulation.collisions().size() << '\n';
}

}  // namespace deltamap::tool
