// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/mapping_drive.hpp"

#include <utility>

#include "daemon/telemetry/stage.hpp"

namespace deltamap::experiments {

MappingDrive::MappingDrive(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& drive,
                           const daemon::Settings& settings, std::shared_ptr<const OccupancyGrid> first_map,
                           bool knows_start)
    : settings_{settings}, drive_{scenario, drive}, last_pose_{drive_.map_from_robot()} {
  settings_.seed = drive.seed;
  const auto start = knows_start ? std::optional{localization::InitialPose{last_pose_}} : std::nullopt;
  localizer_.emplace(settings_.localizer, first_map, start, settings_.seed);
  store_scan_.emplace(settings_.mapping.store_scan, settings_.seed);
  map_.emplace(settings_, daemon::StartMap{.map = std::move(first_map)});
}

Mapped MappingDrive::next() {
  simulation::DriveStep step = drive_.next();
  if (!first_) first_ = step.scan.time;
  Mapped mapped;
  mapped.map_from_robot = step.map_from_robot;
  mapped.changes = std::move(step.changes);
  mapped.events = std::move(step.events);
  mapped.slips = step.slips;
  mapped.about = drive_.movers().bodies();
  mapped.time = step.scan.time;
  mapped.passed_s = seconds(step.scan.time - *first_);
  const double began_s = daemon::thread_cpu_s();
  for (const Odometry& odometry : step.odometry) localizer_->observe(odometry);
  mapped.tracked = localizer_->observe(std::move(step.scan));
  const TrackedScan& tracked = mapped.tracked;
  const double localized_s = daemon::thread_cpu_s();
  mapped.costs.localizer_s = localized_s - began_s;
  mapped.estimate = tracked.estimate;
  last_pose_ = tracked.estimate.map_from_robot;
  const auto set = settings_.mapping.enabled ? store_scan_->observe(tracked) : std::nullopt;
  mapped.awareness = store_scan_->awareness();
  if (things_ != store_scan_->temporary()) localizer_->apply(things_ = store_scan_->temporary());
  mapped.things = things_;
  const double aware_s = daemon::thread_cpu_s();
  mapped.costs.awareness_s = aware_s - localized_s;
  if (!set) return mapped;
  mapped.update = map_->update(*set);
  if (mapped.update->revision) localizer_->apply(*mapped.update->revision);
  mapped.costs.update_s = daemon::thread_cpu_s() - aware_s;
  return mapped;
}

void MappingDrive::restart() {
  const localization::StabilityRecord stability = localizer_->stability();
  const localization::InitialPose kept{last_pose_, settings_.memory.position_deviation_m,
                                       settings_.memory.heading_deviation_rad, true};
  const std::uint64_t seed = settings_.seed + ++starts_;
  localizer_.emplace(settings_.localizer, map_->map(), kept, seed);
  (void)localizer_->restore(stability);
  store_scan_.emplace(settings_.mapping.store_scan, seed);
  map_.emplace(settings_, daemon::StartMap{.map = map_->map(), .revision = map_->revision()});
}

}  // namespace deltamap::experiments
