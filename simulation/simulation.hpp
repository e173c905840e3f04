// SPDX-License-Identifier: Apache-2.0
// A scenario that lives: the robot drives, people walk, the fork-lift works, and both devices talk on their lines. It
// runs in whatever time it is given: `deltamap sim` gives it the clock's, tests give it virtual time as fast as they
// like. The same seed and the same bytes at the same times give the same answers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "simulation/devices/virtual_lms200.hpp"
#include "simulation/devices/virtual_pioneer.hpp"
#include "simulation/faults/faults.hpp"
#include "simulation/faults/named_fault.hpp"
#include "simulation/robot/collision_watch.hpp"
#include "simulation/robot/laser_faults.hpp"
#include "simulation/robot/motion_history.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/truth.hpp"

namespace deltamap::simulation {

struct SimulationParams {
  std::uint64_t seed = 1;
  Timestamp start;                       ///< Unix time at which it begins
  std::optional<double> change_every_s;  ///< in place of the scenario's, > 0
};

class Simulation {
 public:
  Simulation(const Scenario& scenario, const SimulationParams& params);

  /// Lets time pass until `now`; earlier times are ignored. Call it at least at every next_event() for bytes that are
  /// fetched the moment they arrive.
  void advance_to(Timestamp now);
  [[nodiscard]] Timestamp now() const { return now_; }
  /// The next moment at which something moves or a burst of bytes is whole; at most 5 ms away.
  [[nodiscard]] Timestamp next_event() const;

  // The host's end of both lines, now. `host_baud` is the speed at which the host's port stands, or kAnyBaud.
  void send_to_robot(std::span<const std::uint8_t> bytes, unsigned host_baud);
  void send_to_laser(std::span<const std::uint8_t> bytes, unsigned host_baud);
  [[nodiscard]] std::vector<std::uint8_t> bytes_from_robot(unsigned host_baud);
  [[nodiscard]] std::vector<std::uint8_t> bytes_from_laser(unsigned host_baud);
  // Whether the host has a port to open there.
  [[nodiscard]] bool has_robot_port() const { return !faults_.robot_line.is_unplugged; }
  [[nodiscard]] bool has_laser_port() const { return !faults_.laser_line.is_unplugged; }

  /// What truly happened since the last call.
  [[nodiscard]] std::vector<TruthRecord> take_truth();

  [[nodiscard]] Pose2 map_from_robot() const { return history_.map_from_robot_at(now_); }
  [[nodiscard]] const World& world() const { return world_; }
  /// What goes wrong from now on; the scenario's own faults set and clear theirs at their times.
  [[nodiscard]] Faults& faults() { return faults_; }
  [[nodiscard]] const Faults& faults() const { return faults_; }
  /// A fault more, from so long after now. Answers it with its time since the start.
  FaultOrder order(FaultOrder fault);
  /// Ends the ordered faults of that name, those that wait too; all of them without one. Answers how many.
  std::size_t end_faults(std::string_view name = {}) { return fault_schedule_.end(name, faults_); }
  [[nodiscard]] const FaultSchedule& fault_schedule() const { return fault_schedule_; }
  /// Someone carries the robot there, at once; its wheels notice nothing.
  void carry_robot_to(const Pose2& map_from_robot) { body_.carry_to(map_from_robot); }
  /// What its body has bumped into so far.
  [[nodiscard]] const std::vector<Collision>& collisions() const { return collisions_.collisions(); }
  /// To press their buttons and cut their power.
  [[nodiscard]] devices::VirtualPioneer& robot() { return pioneer_; }
  [[nodiscard]] devices::VirtualLms200& laser() { return lms200_; }

 private:
  void run_devices(Timestamp now);
  void move(Timestamp from);
  void note_collisions(Timestamp now);
  void work(Timestamp now);
  void let_forklift_work(Timestamp now);
  void let_containers_creep(Timestamp now);
  void take_place(const std::vector<Change>& changes, Timestamp now);
  [[nodiscard]] std::vector<Beam> measure(const devices::SweepRequest& request);
  [[nodiscard]] std::optional<double> sonar_range_m(int index, Timestamp now) const;
  [[nodiscard]] Circle robot_body() const;

  Scenario scenario_;
  World world_;
  RayCaster surfaces_;
  Robot body_;
  RangeFinder range_finder_;
  FaultyLaser faulty_laser_;
  Faults faults_;
  FaultSchedule fault_schedule_;
  CollisionWatch collisions_;
  Movers movers_;
  std::optional<Forklift> forklift_;
  std::optional<Creep> creep_;
  Duration change_every_{};
  Timestamp next_change_{};
  Timestamp next_push_{};
  devices::VirtualPioneer pioneer_;
  devices::VirtualLms200 lms200_;
  MotionHistory history_;
  Timestamp start_;
  Timestamp now_;
  Timestamp next_truth_;
  double travelled_m_ = 0.0;
  double turned_rad_ = 0.0;
  std::vector<TruthRecord> truth_;
};

}  // namespace deltamap::simulation
