// SPDX-License-Identifier: Apache-2.0
#include "experiments/mapping/calm_drives.hpp"

#include <optional>
#include <utility>

#include "core/random.hpp"
#include "simulation/drawn/unseen_world.hpp"

namespace deltamap::experiments {
namespace {

/// As in `unseen`, but nothing is moved.
simulation::VirtualDriveParams calm(simulation::VirtualDriveParams drive) {
  drive.forklift.reset();
  drive.creep.reset();
  drive.changed_at_start.reset();
  drive.changes_at_start.clear();
  return drive;
}

}  // namespace

void drive_calmly(std::uint64_t seed, double minutes, const CalmDrives& drives) {
  const auto world = simulation::drawn::unseen_world(simulation::drawn::unseen_kind(seed), seed);
  simulation::VirtualDrive drive{world.drawn.scenario, calm(world.drawn.drive)};
  Random random{seed};
  std::optional<Timestamp> began;
  bool is_second = false;
  for (;;) {
    simulation::DriveStep now = drive.next();
    if (!began) began = now.scan.time;
    const double passed_s = seconds(now.scan.time - *began);
    if (passed_s > 60.0 * minutes) return;
    if (is_second || passed_s <= 30.0 * minutes) {
      drives.step(std::move(now));
      continue;
    }
    is_second = true;
    drive.kidnap(drive.place_anywhere(random));
    drives.begin_second(std::move(now));
  }
}

}  // namespace deltamap::experiments
