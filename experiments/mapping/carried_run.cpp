// SPDX-License-Identifier: Apache-2.0
#include "experiments/mapping/carried_run.hpp"

#include "core/grid/near_occupied.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/drive/pose_event.hpp"

namespace deltamap::experiments {
namespace {

struct WrongCells {
  double walls = 0.0;   ///< of the first map that are no walls any more
  double ghosts = 0.0;  ///< walls where the first map has none, nor beside
};

WrongCells wrong_in(const OccupancyGrid& map, const OccupancyGrid& truth) {
  WrongCells wrong;
  for (const CellChange& change : changes_between(truth, map)) {
    if (change.before == CellState::kOccupied) wrong.walls += 1.0;
    if (change.after == CellState::kOccupied && !has_occupied_within(truth, change.cell, 1)) wrong.ghosts += 1.0;
  }
  return wrong;
}

/// Drives on, and counts.
class Watch {
 public:
  Watch(MappingDrive& drive, const OccupancyGrid& truth) : drive_{drive}, truth_{truth} {}

  void until(double end_s) {
    while (passed_s_ < end_s) {
      const Mapped scan = drive_.next();
      passed_s_ = scan.passed_s;
      count(scan);
    }
  }

  ScanTable rows{{"t_s", "error_m", "state", "pose_right", "gate", "revisions", "withdrawn", "walls_wrong", "ghosts"}};
  double revisions = 0.0;
  double withdrawn = 0.0;
  double error_m = 0.0;
  [[nodiscard]] WrongCells wrong() const { return wrong_in(drive_.map(), truth_); }

 private:
  void count(const Mapped& scan) {
    error_m = distance_between(scan.estimate.map_from_robot, scan.map_from_robot);
    if (scan.update && scan.update->revision) {
      const auto taken_back = static_cast<double>(scan.update->note.withdraws.size());
      withdrawn += taken_back;
      revisions += taken_back == 0.0 ? 1.0 : 0.0;
    }
    if (passed_s_ < next_row_s_) return;
    next_row_s_ = passed_s_ + 1.0;
    const WrongCells wrong_now = wrong();
    rows.add({passed_s_, error_m, static_cast<double>(scan.estimate.state), scan.estimate.belief.pose_right,
              static_cast<double>(scan.awareness.gate), revisions, withdrawn, wrong_now.walls, wrong_now.ghosts});
  }

  MappingDrive& drive_;
  const OccupancyGrid& truth_;
  double passed_s_ = 0.0;
  double next_row_s_ = 0.0;
};

}  // namespace

Outcome outcome_of(const CarriedRun& run) {
  const auto first = first_map(run.scenario);
  simulation::VirtualDriveParams params;
  params.seed = run.seed;
  MappingDrive drive{run.scenario, params, run.settings, {.map = first}};
  const Pose2 start = drive.drive().map_from_robot();
  Random random{run.seed + 15485863};
  Watch watch{drive, *first};
  watch.until(run.carried_after_s);
  befall(drive.drive(), PoseEvent::kElsewhere, random);
  watch.until(run.carried_after_s + run.stopped_after_s);
  const WrongCells at_stop = watch.wrong();
  if (run.restarts) drive.restart(run.is_given_again ? std::optional{start} : std::nullopt);
  watch.until(run.carried_after_s + run.stopped_after_s + run.looks_after_s);
  const WrongCells at_end = watch.wrong();
  Outcome outcome;
  outcome.numbers = {{"carried_after_s", run.carried_after_s},
                     {"stopped_after_s", run.stopped_after_s},
                     {"revisions", watch.revisions},
                     {"withdrawn", watch.withdrawn},
                     {"walls_wrong_at_stop", at_stop.walls},
                     {"walls_wrong", at_end.walls},
                     {"ghosts_at_stop", at_stop.ghosts},
                     {"ghosts", at_end.ghosts},
                     {"error_m", watch.error_m}};
  outcome.scans = std::move(watch.rows);
  return outcome;
}

}  // namespace deltamap::experiments
