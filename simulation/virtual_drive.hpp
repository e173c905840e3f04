// SPDX-License-Identifier: Apache-2.0
// A robot that drives about a scenario in virtual time and gives the messages that the drivers would make of its
// devices, without their bytes: as fast as it can be computed, with the truth beside. The same scenario, parameters and
// calls give the same messages, bit for bit.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "drivers/lms200/variant.hpp"
#include "simulation/changes/creep.hpp"
#include "simulation/changes/forklift.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/robot/range_finder.hpp"
#include "simulation/robot/route_pilot.hpp"
#include "simulation/robot/slips.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::simulation {

/// Now and then no scans arrive, while the robot drives on and the world changes.
struct GapParams {
  double every_s = 600.0;  ///< mean time between two, > 0
  double least_s = 1.0;    ///< shortest and longest, log-uniform, > 0
  double most_s = 60.0;
};

/// As delivered the scans are those of an LMS200 at 180/1 and 38400 baud: 181 beams in half a turn of the mirror, every
/// 8th turn (protocols.md B7). The body and its wheels' errors, the laser's optics and mount are the scenario's.
struct VirtualDriveParams {
  std::uint64_t seed = 1;
  std::optional<Pose2> map_from_start{};  ///< in place of the scenario's
  drivers::lms200::ScanVariant fan{180, 100};
  double scan_period_s = 8 * 0.01332;  ///< between first beams, at least a scan's duration (B7)
  double max_range_m = 80.0;           ///< longer readings are kBeyondMaximum; up to 32 in mm, above in cm (B4)
  double odometry_period_s = 0.1;      ///< between SIPs (A6), > 0
  double odometry_lag_s = 0.0;         ///< by which a SIP's content is older than its stamp, >= 0
  std::optional<Pose2> told_mount{};   ///< what scans say of the mount, in place of the truth
  RoutePilotParams route{};
  std::vector<PersonParams> people{};        ///< besides the scenario's
  std::optional<ForkliftParams> forklift{};  ///< none: nothing changes by itself
  double change_in_view_share = 1.0;         ///< of its turns in which it may do something in the robot's sight, [0, 1]
  std::optional<CreepParams> creep{};        ///< none: nothing creeps
  std::optional<ChangedStartParams> changed_at_start{};  ///< in place of the scenario's
  std::vector<Change> changes_at_start{};                ///< besides
  std::optional<SlipParams> slips{};                     ///< besides those of single wheels
  std::optional<GapParams> gaps{};
};

struct DriveStep {
  std::vector<Odometry> odometry;  ///< what arrived before the scan, in order
  Scan scan;
  Pose2 map_from_robot;            ///< the truth at Scan::time
  std::vector<MoverEvent> events;  ///< since the last scan: no changes of the map
  std::vector<Change> changes;     ///< since the last scan, or before the first; the scan shows them
  int slips = 0;                   ///< that have begun since the last scan
};

class VirtualDrive {
 public:
  VirtualDrive(const Scenario& scenario, const VirtualDriveParams& params);

  /// One scan period later.
  [[nodiscard]] DriveStep next();

  // What befalls the robot and the world between two scans.
  /// Carried there; odometry notices nothing. The place must be free.
  void kidnap(const Pose2& map_from_robot);
  /// The body moves that far and the wheels say nothing.
  void slip(const Pose2& robot_from_moved) { kidnap(body_.state().map_from_robot * robot_from_moved); }
  /// The wheels turn that far and the body stands.
  void spin(const Pose2& robot_from_moved) { body_.spin_wheels(robot_from_moved); }
  void change(const Change& change);
  /// From now on it drives this, wherever that leads, and not where its pilot would.
  void hold(const devices::DriveTarget& target) {
    held_ = target;
    next_thought_ = now_;
  }
  /// Many acts of a fork-lift at once, until that share of the slots is not as in the scenario. Fewer where no more can
  /// be done without harm.
  std::vector<Change> change_many(double share, const ForkliftParams& forklift);

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const RayCaster& surfaces() const { return surfaces_; }
  [[nodiscard]] Pose2 map_from_robot() const { return body_.state().map_from_robot; }
  [[nodiscard]] double robot_radius_m() const { return scenario_.robot.body.radius_m; }
  /// People, actors and doors.
  [[nodiscard]] const Movers& movers() const { return movers_; }
  /// Room for a body around it and around everyone.
  [[nodiscard]] bool is_free(const Point2& place) const;
  /// Free, and a robot could drive there from where this one is.
  [[nodiscard]] bool is_on_floor(const Point2& place) const { return pilot_.reaches(place) && is_free(place); }
  /// Free, with any heading.
  [[nodiscard]] Pose2 place_anywhere(Random& random) const;

 private:
  [[nodiscard]] Circle robot_body() const;
  void advance(double dt_s);
  void report_odometry(const RobotState& before, Timestamp from);
  void begin_changed(const ChangedStartParams& start);
  void note_unseen(const Change& change);
  void wait_without_scans();
  void think();
  void drive_until(Timestamp end);
  void let_forklift_work();
  [[nodiscard]] bool is_out_of_sight(const Box& box) const;
  void let_containers_creep();
  void see_changes();
  [[nodiscard]] Scan sweep();

  Scenario scenario_;
  VirtualDriveParams params_;
  World world_;
  RayCaster surfaces_;
  Robot body_;
  RangeFinder range_finder_;
  RoutePilot pilot_;
  Movers movers_;
  std::optional<Forklift> forklift_;
  std::optional<Creep> creep_;
  std::vector<Change> unseen_;  // from before the first scan
  std::size_t many_ = 0;        // calls of change_many
  Timestamp now_;
  Timestamp next_odometry_;
  Timestamp next_change_;
  Timestamp next_push_;
  Timestamp next_thought_;  // of the pilot
  std::optional<Timestamp> next_gap_;
  std::optional<Slips> slips_;
  Random gap_chance_;
  Random sight_chance_;
  devices::DriveTarget target_;
  std::optional<devices::DriveTarget> held_;
  DriveStep step_;
  std::deque<Odometry> under_way_;  // SIPs whose stamps are still to come
  std::uint32_t scans_ = 0;
  Sweep fan_;
  double sweep_s_;
};

}  // namespace deltamap::simulation
