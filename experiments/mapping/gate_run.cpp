// SPDX-License-Identifier: Apache-2.0
#include "experiments/mapping/gate_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/lived_in.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/watch/error_course.hpp"

namespace deltamap::experiments {
namespace {

/// Cells that were written while the pose was wrong, until it is looked whether they stand.
struct Astray {
  double written_s = 0.0;
  std::vector<CellChange> changes;
};

BeamCounts all_beams(const Belief& belief) {
  const BeamCounts& one = belief.stable;
  const BeamCounts& other = belief.elsewhere;
  return {one.expected + other.expected, one.fit + other.fit, one.short_of + other.short_of, one.beyond + other.beyond};
}

class Count {
 public:
  explicit Count(const GateRun& run) : run_{run} {}

  void observe(const Mapped& scan, double error_m, const OccupancyGrid& map) {
    errors_.add(scan.time, error_m);
    while (!astray_.empty() && scan.passed_s - astray_.front().written_s >= run_.look_back_s) look_back(map);
    if (!scan.update) return;
    const daemon::MapStep::Result& update = *scan.update;
    if (update.note.reason == "pose in doubt") refused_ += 1.0;
    if (!update.revision) return;
    const std::vector<CellChange>& changes = update.revision->changes;
    if (!update.note.withdraws.empty()) {
      withdrawn_ += static_cast<double>(update.note.withdraws.size());
      withdrawn_cells_ += static_cast<double>(changes.size());
      return;
    }
    revisions_ += 1.0;
    cells_ += static_cast<double>(changes.size());
    if (errors_.at_m(update.note.time) > run_.wrong_pose_m) cells_drawn_astray_ += static_cast<double>(changes.size());
    if (error_m <= run_.wrong_pose_m) return;
    cells_astray_ += static_cast<double>(changes.size());
    astray_.push_back({scan.passed_s, changes});
  }

  [[nodiscard]] std::vector<std::pair<std::string, double>> numbers(const OccupancyGrid& map) {
    while (!astray_.empty()) look_back(map);
    return {{"revisions", revisions_},
            {"cells", cells_},
            {"cells_astray", cells_astray_},
            {"cells_drawn_astray", cells_drawn_astray_},
            {"cells_astray_that_stood", cells_that_stood_},
            {"revisions_withdrawn", withdrawn_},
            {"cells_withdrawn", withdrawn_cells_},
            {"sets_refused_in_doubt", refused_}};
  }

 private:
  void look_back(const OccupancyGrid& map) {
    for (const CellChange& change : astray_.front().changes) {
      if (map[change.cell] == change.after) cells_that_stood_ += 1.0;
    }
    astray_.pop_front();
  }

  const GateRun& run_;
  std::deque<Astray> astray_;
  double revisions_ = 0.0;
  double cells_ = 0.0;
  double cells_astray_ = 0.0;
  double cells_drawn_astray_ = 0.0;  // where the pose was wrong when their set ended
  ErrorCourse errors_;
  double cells_that_stood_ = 0.0;
  double withdrawn_ = 0.0;
  double withdrawn_cells_ = 0.0;
  double refused_ = 0.0;
};

/// What passed between two readings of the gate's clock.
mapping::gate::GateTimes between(const mapping::gate::GateTimes& earlier, const mapping::gate::GateTimes& later) {
  mapping::gate::GateTimes times{};
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = later[i] - earlier[i];
  return times;
}

void add_shares(const mapping::gate::GateTimes& times, const std::string& when, Outcome& outcome) {
  const double all_s = mapping::gate::observed_s(times);
  outcome.numbers.emplace_back("shut_" + when, mapping::gate::shut_s(times) / all_s);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const auto reason = static_cast<mapping::gate::GateReason>(i);
    outcome.numbers.emplace_back("shut_" + when + "_" + std::string{name_of(reason)}, times[i] / all_s);
  }
}

/// How long the pose was wrong, and how long of that the gate was open.
class WrongTimes {
 public:
  void add(double passed_s, bool is_wrong, bool is_open) {
    if (is_wrong) wrong_s_ += passed_s - last_s_;
    if (is_wrong && is_open) unnoticed_s_ += passed_s - last_s_;
    last_s_ = passed_s;
  }
  [[nodiscard]] double wrong_s() const { return wrong_s_; }
  [[nodiscard]] double unnoticed_s() const { return unnoticed_s_; }

 private:
  double wrong_s_ = 0.0;
  double unnoticed_s_ = 0.0;
  double last_s_ = 0.0;
};

ScanTable no_rows() {
  return ScanTable{{"t_s", "error_m", "state", "verdict", "pose_right", "rival_share", "deviation_m", "gate", "written",
                    "withdrawn", "x_m", "y_m", "expected", "fit", "short_of", "beyond"}};
}

void add_row(ScanTable& scans, const Mapped& scan, double error_m) {
  const Estimate& estimate = scan.estimate;
  const BeamCounts beams = all_beams(estimate.belief);
  const bool withdrew = scan.update && !scan.update->note.withdraws.empty();
  const double written = scan.update && scan.update->revision && !withdrew
                             ? static_cast<double>(scan.update->revision->changes.size())
                             : 0.0;
  scans.add({scan.passed_s, error_m, static_cast<double>(estimate.state), static_cast<double>(estimate.belief.verdict),
             estimate.belief.pose_right, estimate.belief.other_share,
             std::sqrt(estimate.covariance.topLeftCorner<2, 2>().trace()), static_cast<double>(scan.awareness.gate),
             written, withdrew ? static_cast<double>(scan.update->revision->changes.size()) : 0.0,
             scan.map_from_robot.x, scan.map_from_robot.y, 1.0 * beams.expected, 1.0 * beams.fit, 1.0 * beams.short_of,
             1.0 * beams.beyond});
}

}  // namespace

Outcome outcome_of(const GateRun& run) {
  const auto first = first_map(run.scenario);
  simulation::VirtualDriveParams params;
  params.seed = run.seed;
  params.forklift = busy_forklift(run.change_every_s);
  MappingDrive drive{run.scenario, params, run.settings, {first}};
  Random random{run.seed + 104729};
  Count count{run};
  WrongTimes times;
  Outcome outcome;
  outcome.scans = no_rows();
  bool befallen = false;
  mapping::gate::GateTimes times_before{};
  for (double passed_s = 0.0; passed_s < run.before_s + run.after_s;) {
    if (!befallen && passed_s >= run.before_s) {
      befallen = true;
      befall(drive.drive(), run.event, random);
    }
    const Mapped scan = drive.next();
    passed_s = scan.passed_s;
    if (!befallen) times_before = scan.awareness.gate_times;
    const double error_m = distance_between(scan.estimate.map_from_robot, scan.map_from_robot);
    count.observe(scan, error_m, drive.map());
    times.add(passed_s, error_m > run.wrong_pose_m, scan.awareness.gate == mapping::gate::GateReason::kOpen);
    add_row(outcome.scans, scan, error_m);
    if (passed_s < run.before_s + run.after_s) continue;
    add_shares(times_before, "before", outcome);
    add_shares(between(times_before, scan.awareness.gate_times), "after", outcome);
  }
  const auto counted = count.numbers(drive.map());
  outcome.numbers.insert(outcome.numbers.begin(), counted.begin(), counted.end());
  outcome.numbers.emplace_back("wrong_s", times.wrong_s());
  outcome.numbers.emplace_back("wrong_and_open_s", times.unnoticed_s());
  return outcome;
}

}  // namespace deltamap::experiments
