// SPDX-License-Identifier: Apache-2.0
// A daemon in virtual time that keeps incidents while it drives in a room.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/incidents/incident_keeper.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/run_begin.hpp"
#include "experiments/closed_loop/loop_run.hpp"
#include "experiments/closed_loop/virtual_daemon.hpp"
#include "simulation/scenario/start_map.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/worlds/quiet_room.hpp"

namespace deltamap::test {

inline constexpr Timestamp kIncidentStart = timestamp_from_ns(1'700'000'000'000'000'000);

class IncidentDrive : public testing::Test {
 protected:
  IncidentDrive() {
    settings_ = experiments::fitting(scenario_);
    settings_.incidents.folder = folder_.path() / "incidents";
    settings_.map.file = "site.yaml";
    map_ = std::make_shared<const OccupancyGrid>(simulation::start_map(scenario_, 0.05));
  }

  /// Begins, and lets the pilot drive.
  void start() {
    world_ = std::make_unique<simulation::Simulation>(
        scenario_, simulation::SimulationParams{.seed = 1, .start = kIncidentStart, .change_every_s = {}});
    experiments::VirtualDaemon::Params params{.settings = settings_, .map = map_};
    params.listener = [this](daemon::Telemetry& telemetry) { return listener(telemetry); };
    daemon_ = std::make_unique<experiments::VirtualDaemon>(*world_, std::move(params));
    daemon_->start();
    drive(experiments::kConnectS);
    (void)daemon_->operator_says(true);
  }

  virtual std::unique_ptr<daemon::RunListener> listener(daemon::Telemetry& telemetry) {
    const std::uint64_t hash = grid_hash(*map_);
    const auto say = [this](const std::string& line) {
      log_.add(world_->now(), line, false);
      lines_.push_back(line);
    };
    return begun_incident_keeper({.settings = settings_,
                                  .first_notes = first_notes(settings_, hash, {hash, 0, {map_, 0}}),
                                  .first_map = hash,
                                  .map = map_,
                                  .began = world_->now()},
                                 telemetry, log_, {say, say});
  }

  void drive(double for_s) {
    daemon_->run(for_s, [this] {
      if (const auto& estimate = daemon_->estimate()) poses_[estimate->time] = estimate->map_from_robot;
    });
  }

  daemon::control::CommandOutcome mark(const std::string& words) {
    return daemon_->listener()->hear(daemon::MarkOrder{words, 1}, world_->now());
  }

  [[nodiscard]] std::vector<daemon::StoredIncident> kept() const {
    return daemon::incidents_in(settings_.incidents.folder);
  }

  /// As `deltamap incident replay` does.
  daemon::RunReport replay(const daemon::StoredIncident& stored, const std::string& out,
                           std::function<void(const daemon::ReplayedScan&)> watch = {}) {
    daemon::ReplayJob job;
    job.recording = stored.folder / daemon::kIncidentRecording;
    job.map = stored.folder / daemon::kIncidentMap;
    job.settings = daemon::read_settings(stored.folder / daemon::kIncidentSettings, {});
    job.out = folder_.path() / out;
    job.watch.scan = std::move(watch);
    return daemon::run_replay(job, [](double) { return true; });
  }

  TemporaryFolder folder_;
  simulation::Scenario scenario_ = quiet_room();
  daemon::Settings settings_;
  std::shared_ptr<const OccupancyGrid> map_;
  daemon::LogTail log_;
  std::vector<std::string> lines_;
  std::map<Timestamp, Pose2> poses_;  // live, by the time of the scan
  std::unique_ptr<simulation::Simulation> world_;
  std::unique_ptr<experiments::VirtualDaemon> daemon_;
};

}  // namespace deltamap::test
