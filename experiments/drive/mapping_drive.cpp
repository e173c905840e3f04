// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/mapping_drive.hpp"

#include <utility>

namespace deltamap::experiments {
namespace {

constexpr double kMapDelay_s = 0.0;  // a revision is taken before the next scan

daemon::StageCpu between(const daemon::StageCpu& before, const daemon::StageCpu& after) {
  return {.localization_s = after.localization_s - before.localization_s,
          .awareness_s = after.awareness_s - before.awareness_s,
          .map_update_s = after.map_update_s - before.map_update_s};
}

}  // namespace

MappingDrive::MappingDrive(const simulation::Scenario& scenario, const simulation::VirtualDriveParams& drive,
                           const daemon::Settings& settings, const daemon::StartMap& start, bool knows_start)
    : settings_{settings}, drive_{scenario, drive}, last_pose_{drive_.map_from_robot()} {
  settings_.seed = drive.seed;
  settings_.initial_pose.reset();
  if (knows_start) settings_.initial_pose = last_pose_;
  run_.emplace(settings_, start, nullptr, kMapDelay_s);
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
  const daemon::StageCpu before = run_->cpu();
  for (const Odometry& odometry : step.odometry) run_->observe(odometry);
  run_->take_what_is_due(step.scan);
  mapped.tracked = run_->observe(std::move(step.scan));
  mapped.estimate = mapped.tracked.estimate;
  last_pose_ = mapped.estimate.map_from_robot;
  if (settings_.mapping.enabled) {
    if (const auto request = run_->look_for_changes(mapped.tracked)) mapped.update = run_->update_map(*request);
  }
  mapped.awareness = run_->store_scan().awareness();
  mapped.transients = run_->store_scan().transients();
  mapped.costs = between(before, run_->cpu());
  return mapped;
}

void MappingDrive::restart(const std::optional<Pose2>& given) {
  const daemon::LocalizationStep& localization = run_->localization();
  daemon::StartMap kept{.map = run_->map().map(), .revision = run_->map().revision()};
  kept.provisional = run_->map().provisional();
  if (localization.row().is_sure()) kept.remembered = last_pose_;
  kept.stability = localization.stability();
  kept.calibration = localization.calibration();
  settings_.initial_pose = given;
  ++settings_.seed;
  run_.emplace(settings_, kept, nullptr, kMapDelay_s);
}

daemon::Settings localizer_alone(const localization::LocalizerParams& params) {
  daemon::Settings settings;
  settings.localizer = params;
  settings.mapping.enabled = false;
  return settings;
}

PoseError error_of(const Mapped& scan) {
  const Pose2& estimate = scan.estimate.map_from_robot;
  return {estimate.position() - scan.map_from_robot.position(),
          turn_between(scan.map_from_robot.theta, estimate.theta)};
}

}  // namespace deltamap::experiments
