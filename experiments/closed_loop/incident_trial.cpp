// SPDX-License-Identifier: Apache-2.0
#include "experiments/closed_loop/incident_trial.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/files/scratch_folder.hpp"
#include "core/random.hpp"
#include "daemon/incidents/incident_keeper.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "daemon/replay/incident_replay.hpp"
#include "daemon/steps/run_begin.hpp"
#include "experiments/closed_loop/loop_run.hpp"
#include "experiments/closed_loop/virtual_daemon.hpp"
#include "simulation/scenario/start_map.hpp"

namespace deltamap::experiments {
namespace {

constexpr Timestamp kTrialStart = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr double kTrialMapResolutionM = 0.05;
constexpr double kCarriedAtLeastM = 2.0;
constexpr double kRoomToStandM = 0.5;
constexpr double kLaserOffS = 20.0;

bool is_ordered(const std::string& cause) {
  return cause != "carried" && cause != "marked" && cause != "laser-off" && cause != "cable-pulled";
}

/// A place with room around it, some metres away.
Pose2 elsewhere(const OccupancyGrid& map, const Pose2& from, Random& random) {
  const GridGeometry& grid = map.geometry();
  const int margin = static_cast<int>(kRoomToStandM / grid.resolution_m);
  for (;;) {
    const Cell cell{static_cast<int>(random.index_below(static_cast<std::uint32_t>(grid.width))),
                    static_cast<int>(random.index_below(static_cast<std::uint32_t>(grid.height)))};
    bool is_free = true;
    for (int row = cell.row - margin; row <= cell.row + margin && is_free; ++row) {
      for (int column = cell.column - margin; column <= cell.column + margin && is_free; ++column)
        is_free = grid.contains({column, row}) && map.at({column, row}) == CellState::kFree;
    }
    const Point2 place = grid.origin + grid.resolution_m * Point2{cell.column + 0.5, cell.row + 0.5};
    const Pose2 there{place.x(), place.y(), random.uniform(-3.1, 3.1)};
    if (is_free && distance_between(from, there) >= kCarriedAtLeastM) return there;
  }
}

class Trial {
 public:
  Trial(const IncidentTrial& trial, simulation::Scenario scenario, daemon::Settings settings)
      : trial_{trial},
        settings_{std::move(settings)},
        map_{std::make_shared<const OccupancyGrid>(simulation::start_map(scenario, kTrialMapResolutionM))},
        world_{with_cause(std::move(scenario)), {.seed = trial.seed, .start = kTrialStart, .change_every_s = {}}},
        random_{trial.seed} {
    settings_.seed = trial.seed;
    settings_.incidents.folder = folder_.path();
  }

  void run() {
    VirtualDaemon::Params params{.settings = settings_, .map = map_};
    params.listener = [this](daemon::Telemetry& telemetry) { return keeper(telemetry); };
    VirtualDaemon daemon{world_, std::move(params)};
    daemon.start();
    daemon.run(kConnectS);
    (void)daemon.operator_says(true);
    daemon.run(trial_.before_s);
    befall(daemon);
    daemon.run(trial_.after_s);
    daemon.listener()->close(world_.now());
  }

  [[nodiscard]] std::vector<TriedIncident> tried() const {
    std::vector<TriedIncident> all;
    for (const daemon::StoredIncident& stored : daemon::incidents_in(folder_.path())) {
      const daemon::Incident& incident = stored.incident;
      const Timestamp event = incident.events.front().time;
      TriedIncident one{.incident = incident, .before_s = seconds(event - incident.from)};
      one.after_s = incident.to ? seconds(*incident.to - event) : 0.0;
      one.bytes = static_cast<double>(stored.bytes);
      one.has_loss = daemon::loss_of(incident) != nullptr;
      if (one.has_loss) replay(stored, one);
      all.push_back(std::move(one));
    }
    return all;
  }

 private:
  [[nodiscard]] simulation::Scenario with_cause(simulation::Scenario scenario) const {
    if (is_ordered(trial_.cause))
      scenario.faults.push_back(simulation::fault_order(trial_.cause, kConnectS + trial_.before_s));
    return scenario;
  }

  std::unique_ptr<daemon::RunListener> keeper(daemon::Telemetry& telemetry) {
    const std::uint64_t hash = grid_hash(*map_);
    const auto say = [](const std::string&) {};
    return begun_incident_keeper({.settings = settings_,
                                  .first_notes = first_notes(settings_, hash, {hash, 0, {map_, 0}}),
                                  .first_map = hash,
                                  .map = map_,
                                  .began = world_.now()},
                                 telemetry, log_, {say, say});
  }

  void befall(VirtualDaemon& daemon) {
    const std::string& cause = trial_.cause;
    if (cause == "carried") world_.carry_robot_to(elsewhere(*map_, world_.map_from_robot(), random_));
    if (cause == "marked") (void)daemon.listener()->hear(daemon::MarkOrder{"trial", 1}, world_.now());
    if (cause == "laser-off") world_.laser().cut_power(world_.now(), kLaserOffS);
    if (cause == "cable-pulled") daemon.pull_adapter(true);
  }

  void replay(const daemon::StoredIncident& stored, TriedIncident& one) const {
    const ScratchFolder out;
    daemon::ReplayJob job = daemon::incident_job(stored.folder);
    job.out = out.path() / "run";
    const auto again = daemon::replayed_incident(stored.incident, std::move(job), [](double) { return true; });
    one.met_again = again.late_s.has_value();
    one.late_s = again.late_s.value_or(0.0);
  }

  IncidentTrial trial_;
  daemon::Settings settings_;
  ScratchFolder folder_;
  std::shared_ptr<const OccupancyGrid> map_;
  simulation::Simulation world_;
  Random random_;
  daemon::LogTail log_;
};

}  // namespace

std::vector<TriedIncident> incidents_of(const IncidentTrial& trial, const simulation::Scenario& scenario,
                                        const daemon::Settings& settings) {
  Trial drive{trial, scenario, fitting(scenario, settings)};
  drive.run();
  return drive.tried();
}

}  // namespace deltamap::experiments
